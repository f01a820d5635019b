#pragma once

#include <cstddef>
#include <optional>

#include "compiler/detail/graph/symmetry.h"
#include "compiler/povray/cut/choose.h"
#include "compiler/povray/cut/placed.h"

namespace graftal {

struct AssemblyLimits {
    double memory_bytes = 0;    ///< by PovrayCosts (costs.h)
    double work_seconds = 0;    ///< by WorkRates (work.h)
    double slowness = 1;        ///< slowness_of_graph()
    WorkMeter* meter = nullptr; ///< counts pieces and placements; may be null
    double needed_bytes = 0;    ///< about, where what was counted takes more than there is
};

/// Unfolds the graph down to the pieces that become meshes, depth first. Nothing if a limit is passed on the
/// way; what was done is taken off the work that is left. Without self_shadows, what is culled has its own
/// light.
std::optional<PlacedPieces> place_pieces(const DetailGraph& cut, const Symmetry& symmetry,
                                         const Projection& projection, const Piece& root,
                                         const Choice& choice, Weights& weights, AssemblyLimits& limits,
                                         const SelfShadows* self_shadows = nullptr);

} // namespace graftal
