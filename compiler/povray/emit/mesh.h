#pragma once

#include <string_view>

#include "compiler/povray/cut_parts.h"
#include "compiler/povray/emit/progress_marks.h"
#include "compiler/povray/sdl_writer.h"

namespace graftal {

/// `#declare NAME = mesh2 { ... }`, without texture. `palette` adds a point of texture space to each
/// triangle, by its slot (palette.h). `solid` lets POV-Ray tell what lies inside. Requires at least one
/// triangle. False if the sink stopped.
bool declare_mesh(SdlWriter& out, std::string_view name, const Mesh& mesh, bool palette, bool solid,
                  ProgressMarks& progress);

/// A direction that is parallel to no face that anybody would write.
inline constexpr std::string_view inside_vector = " inside_vector <0.3172,0.8391,0.4419>";

} // namespace graftal
