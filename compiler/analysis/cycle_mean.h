#pragma once

#include <vector>

#include "compiler/analysis/cycle_graph.h"

namespace graftal {

/// The largest mean of edge weights over the cycles of a strong component.
struct CycleMean {
    double mean = 0;                  ///< of `cycle`: a lower bound, in practice the maximum itself
    double bound = 0;                 ///< max over edges of weight + potential[to] - potential[from] >= mean
    std::vector<std::uint32_t> cycle; ///< edge numbers in order, simple
    std::vector<double> potential;    ///< by local object
};

/// Policy iteration (Howard 1960; Cochet-Terrasson et al. 1998; the value pass over all edges as in Dasdan
/// 2004). Bounded effort: `bound` holds in any case, because it is measured. Requires finite weights.
CycleMean max_cycle_mean(const CycleGraph& cycle, const std::vector<double>& weight);

} // namespace graftal
