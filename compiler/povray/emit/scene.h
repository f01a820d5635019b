#pragma once

#include <string_view>
#include <vector>

#include "compiler/povray/cut_parts.h"
#include "compiler/povray/output.h"
#include "compiler/scene/scene.h"

namespace graftal {

/// Writes the scene as POV-Ray 3.7 SDL: literal placements of shared meshes, grouped by texture; the whole
/// scaled so that it is about 1000 units large. Returns false if the sink stopped it. `palettes` receives
/// the pictures to write beside it, all before the sink gets its first piece. Deterministic.
bool emit_povray(const Cut& cut, const View& view, const PovrayOptions& options, const TextSink& sink,
                 std::vector<PaletteImage>& palettes);

} // namespace graftal
