#pragma once

#include <string_view>

#include "compiler/povray/cut_parts.h"
#include "compiler/povray/emit/progress_marks.h"
#include "compiler/povray/sdl_writer.h"

namespace graftal {

/// `#declare NAME = mesh2 { ... }`, without texture. `palette` adds a point of texture space to each
/// triangle, by its slot (palette.h). Requires at least one triangle. False if the sink stopped.
bool declare_mesh(SdlWriter& out, std::string_view name, const Mesh& mesh, bool palette,
                  ProgressMarks& progress);

} // namespace graftal
