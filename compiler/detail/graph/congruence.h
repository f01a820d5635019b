#pragma once

#include <vector>

#include "compiler/detail/graph/symmetry.h"

namespace graftal {

/// The node pairs of a Symmetry followed to their ends: nodes whose geometry is the same, moved. Unlike the
/// classes of Symmetry this minds every pair that a mesh rests on, by any isometry. It also minds the
/// isometries that take a node to itself.
struct Congruence {
    std::vector<NodeId> root; ///< by node: the first of its group
    std::vector<Affine> node_from_root;
    std::vector<std::vector<Affine>>
        symmetries;                   ///< by node, of roots only: isometries, the identity left out
    std::vector<std::uint32_t> order; ///< pairs, each after one that leads to one of its nodes
};

Congruence find_congruence(const DetailGraph& cut, const Symmetry& symmetry);

} // namespace graftal
