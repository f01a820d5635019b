#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace graftal {

/// A directed multigraph whose nodes and edges carry labels.
struct LabelledGraph {
    struct Edge {
        std::uint32_t to = 0;
        double label = 0;
    };
    std::vector<double> label;            ///< by node
    std::vector<std::vector<Edge>> edges; ///< by node
};

/// A grouping in which nodes of one class have equal labels and, class by class, equal multisets of edges:
/// what depends on these only (counts, growth rates) may be computed on the classes.
struct Partition {
    std::vector<std::uint32_t> class_of;       ///< numbered by first member
    std::vector<std::uint32_t> representative; ///< by class: its first member
    std::uint32_t size() const { return static_cast<std::uint32_t>(representative.size()); }
};

/// The coarsest such grouping, by rounds of refinement; where these do not end soon, every node by itself.
/// O(edges * log) a round.
Partition group_equal_nodes(const LabelledGraph& graph);

} // namespace graftal
