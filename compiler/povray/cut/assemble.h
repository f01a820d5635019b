#pragma once

#include <optional>

#include "compiler/detail/graph/symmetry.h"
#include "compiler/povray/cut/choose.h"
#include "compiler/povray/cut/place_pieces.h"
#include "compiler/povray/cut_parts.h"

namespace graftal {

class ShellStore;

/// Unfolds the graph down to the chosen threshold and bakes what lies below: placements in depth-first order,
/// which keeps neighbours together. Nothing if a limit is passed on the way: placements are counted before
/// they are stored. Takes what was done off the work that is left. `shells`: of this graph. `self_shadows`:
/// place_pieces()'.
std::optional<Cut> assemble(const DetailGraph& cut, const Symmetry& symmetry, const Projection& projection,
                            const Piece& root, const Choice& choice, Weights& weights, bool limit_normals,
                            ShellStore& shells, AssemblyLimits& limits,
                            const SelfShadows* self_shadows = nullptr);

} // namespace graftal
