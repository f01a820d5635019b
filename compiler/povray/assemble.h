#pragma once

#include <cstdint>

#include "compiler/detail/symmetry.h"
#include "compiler/povray/choose.h"
#include "compiler/povray/cut.h"

namespace graftal {

struct AssemblyLimits {
    std::size_t max_placements = 0;
    std::size_t max_triangles = 0;
    double work_seconds = 0;    ///< by WorkRates (work.h)
    double slowness = 1;        ///< slowness_of_graph()
    WorkMeter* meter = nullptr; ///< counts pieces; null: nobody does
};

class ShellStore;

/// Unfolds the graph down to the chosen threshold and bakes what lies below: placements in depth-first order,
/// which keeps neighbours together. Nothing if a limit is passed on the way. Takes what was done off the work
/// that is left. `shells`: of this graph.
std::optional<Cut> assemble(const CutGraph& cut, const Symmetry& symmetry, const Projection& projection,
                            const Piece& root, const Choice& choice, Weights& weights, bool limit_normals,
                            ShellStore& shells, AssemblyLimits& limits);

} // namespace graftal
