#pragma once

#include <algorithm>
#include <cstddef>

#include "compiler/detail/graph/detail_graph.h"

namespace graftal {

/// Computes a value of each node from those of its children, on cycles too. `update(id)` computes it anew,
/// and says by how much it changed. It is called on every node with edges, masters first, until none changes
/// by `enough`. In a cycle that draws little besides itself that takes long. So small graphs get more sweeps
/// than the `fewest` that end any.
template<typename Update>
void settle(const DetailGraph& cut, int fewest, double enough, const Update& update) {
    constexpr std::size_t enough_edges = 4'000'000, most_sweeps = 100'000;
    const std::vector<NodeId> order = masters_first(cut);
    std::size_t edges = 1;
    for (const DetailNode& node : cut.nodes)
        edges += node.edges.size();
    const auto sweeps = std::clamp(enough_edges / edges, static_cast<std::size_t>(fewest), most_sweeps);
    for (std::size_t sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0;
        for (const NodeId id : order)
            if (!cut.nodes[id].primitive && !cut.nodes[id].edges.empty())
                change = std::max(change, update(id));
        if (change < enough) return;
    }
}

} // namespace graftal
