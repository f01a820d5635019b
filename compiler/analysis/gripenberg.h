#pragma once

#include <cstdint>
#include <vector>

#include "compiler/analysis/cycle_graph.h"
#include "compiler/analysis/metric.h"

namespace graftal {

/// Findings of a search over the paths of a component.
struct PathSearch {
    double log_lower = 0;            ///< of the closed walk that grows fastest, per instance
    std::vector<std::uint32_t> walk; ///< if better than the one that was known; edge numbers
    double log_rate = 0;             ///< every path of `depth` instances has a prefix that shrinks as much
    int depth = 0;
    std::uint64_t products = 0; ///< effort taken
};

struct PathSearchLimits {
    double log_lower = 0;       ///< known from a closed walk
    bool prove = false;         ///< seek any rate below 1; else one that is 1 % above the lower bound
    std::uint64_t products = 0; ///< effort
};

/// Gripenberg's branch and bound (1996) on paths: a path is followed no further once a prefix has shrunk at
/// the rate sought, by the metrics and weights of `choice`. Stops early at a walk that grows. Where effort
/// runs out, `log_rate` is what holds by how far paths were followed.
PathSearch search_paths(const CycleGraph& cycle, const MetricChoice& choice, const PathSearchLimits& limits);

} // namespace graftal
