#pragma once

#include <cstdint>
#include <vector>

#include "compiler/detail/cut_graph.h"

namespace graftal {

/// The geometry of node `b` is that of node `a` moved by `b_from_a`; colours may differ. `edge` and
/// `stop_edge` pair the followed edges of a with those of b, `edge_pair` and `stop_pair` say which pair the
/// two children form.
struct NodePair {
    NodeId a = 0;
    NodeId b = 0;
    Affine b_from_a;
    std::vector<std::uint32_t> edge;
    std::vector<std::uint32_t> edge_pair;
    std::vector<std::uint32_t> stop_edge;
    std::vector<std::uint32_t> stop_pair;
};

/// Nodes sorted into classes of congruent geometry. Each node is an image of its class's representative, by
/// an isometry whose linear part is a signed permutation of the axes (the symmetries of the cube).
struct Symmetry {
    std::vector<NodeId> representative; ///< by node
    std::vector<Affine> node_from_representative;
    std::vector<std::uint32_t> pair; ///< by node: (representative, node) in `pairs`
    std::vector<NodePair> pairs;
    std::uint64_t comparisons = 0; ///< of two edges: what finding all this has cost
};

/// Where a node is its own image under a half turn or mirror that leaves none of its edges in place, it is
/// replaced by two placements of one half: the choice of the cut gets finer, meshes half as large. Changes
/// no unfolding.
void split_into_halves(CutGraph& cut);

/// Finds the classes: candidates are checked coinductively (a pair is congruent if its edges can be paired so
/// that all child pairs are), so cycles are no obstacle. Sound; it may miss congruences where several edges
/// of a node coincide. Bounded effort. All balls of a class become images of its smallest.
Symmetry find_symmetry(CutGraph& cut);

} // namespace graftal
