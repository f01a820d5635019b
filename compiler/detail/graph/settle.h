#pragma once

#include <algorithm>

#include "compiler/detail/graph/cut_graph.h"

namespace graftal {

/// Computes a value of each node from those of its children, on cycles too. `update(id)` computes it anew,
/// and says by how much it changed. It is called on every node with edges, masters first, up to `sweeps`
/// times, until none changes by `enough`.
template<typename Update> void settle(const CutGraph& cut, int sweeps, double enough, const Update& update) {
    const std::vector<NodeId> order = masters_first(cut);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0;
        for (const NodeId id : order)
            if (!cut.nodes[id].primitive && !cut.nodes[id].edges.empty())
                change = std::max(change, update(id));
        if (change < enough) return;
    }
}

} // namespace graftal
