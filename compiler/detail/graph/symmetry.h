#pragma once

#include <cstdint>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/passes/congruent_pairs.h"

namespace graftal {

/// Nodes sorted into classes of congruent geometry. Each node is an image of its class's representative by
/// an isometry. Its linear part is a signed permutation of the axes (a symmetry of the cube).
struct Symmetry {
    std::vector<NodeId> representative; ///< by node
    std::vector<Affine> node_from_representative;
    std::vector<std::uint32_t> pair; ///< by node: (representative, node) in `pairs`
    std::vector<NodePair> pairs;
    std::uint64_t comparisons = 0; ///< comparisons of two edges: the cost of all this
};

/// Finds the classes (passes/congruent_pairs.h). Bounded effort. All balls of a class become images of its
/// smallest.
Symmetry find_symmetry(DetailGraph& cut);

} // namespace graftal
