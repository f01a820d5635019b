#pragma once

#include <cstdint>
#include <vector>

#include "compiler/unfolded/flat.h"

namespace graftal {

/// Whether the map of an edge scales evenly, as single precision sees it.
bool is_similarity(const FlatEdge& edge);

/// An edge of a FlatGraph, or two after each other as one: a ray spares the node between them.
struct PassedEdge {
    FlatEdge edge;
    std::uint32_t before =
        flat_none; ///< the two, by number in FlatCells::edges; none: the edge is the graph's own
    std::uint32_t last = flat_none; ///< which is the graph's own
};

/// Parts of several levels of one node that are met as one set, while none of the nodes passed over is cut.
struct FlatCell {
    std::vector<std::uint32_t> edges; ///< by number in FlatCells::edges
    float least_size = 0;             ///< least diameter of what is passed over, over the detail that cuts it
    float reach = 0;                  ///< of that, from the node's centre
    std::uint32_t least_steps = 0;    ///< levels that the node must have left
};

struct FlatCells {
    std::vector<PassedEdge> edges;                   ///< the graph's come first, by their numbers there
    std::vector<std::vector<std::uint32_t>> shallow; ///< by node: its edges; those of groups that are never
                                                     ///< cut in place of the groups
    std::vector<std::vector<FlatCell>> deep;         ///< by node, each of one level more than the one before
};

/// Cells for all nodes, of 512 parts at most each. They grow the graph by 65,536 edges at most.
FlatCells flat_cells(const FlatGraph& graph);

} // namespace graftal
