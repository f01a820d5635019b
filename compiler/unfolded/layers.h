#pragma once

#include <vector>

#include "compiler/detail/graph/detail_graph.h"

namespace graftal {

/// A graph that is unfolded to few levels, each unending node once for every number of levels that it may
/// have left. What is drawn with three levels left may be much less than the limit set, and so are its
/// bounds: a tree that would grow for ever, cut after eight years.
struct LayeredGraph {
    DetailGraph cut;            ///< its materials are left out
    std::vector<NodeId> source; ///< by node: which of the graph's it is
};

/// The layers for `root_steps` levels of the root. The graph itself if these are not limited, or so many
/// that the picture is that of the limit set.
LayeredGraph layered(const DetailGraph& cut, std::uint32_t root_steps);

} // namespace graftal
