#include "compiler/detail/cut_graph.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

MeanColour mean_of(const CutGraph& cut, const CutNode& node) {
    MeanColour sum{Rgb(0.0), 0};
    double weights = 0;
    for (const CutEdge& edge : node.edges) {
        MeanColour mean = cut.nodes[edge.child].mean;
        if (edge.material) mean = {mean.over(cut.materials[*edge.material].rgb), 0};
        sum.fixed += edge.weight * edge.tint.over(mean.fixed);
        sum.open += edge.weight * (1 - edge.tint.alpha) * mean.open;
        weights += edge.weight;
    }
    return {sum.fixed / weights, sum.open / weights};
}

} // namespace

std::vector<NodeId> masters_first(const CutGraph& cut) {
    std::vector<NodeId> order;
    std::vector<bool> met(cut.nodes.size(), false);
    std::vector<std::pair<NodeId, std::size_t>> path;
    for (NodeId start = 0; start < cut.nodes.size(); ++start) {
        if (!met[start]) path.emplace_back(start, 0);
        met[start] = true;
        while (!path.empty()) {
            const std::vector<CutEdge>& edges = cut.nodes[path.back().first].edges;
            if (path.back().second == edges.size()) {
                order.push_back(path.back().first);
                path.pop_back();
                continue;
            }
            const NodeId child = edges[path.back().second++].child;
            if (!met[child]) path.emplace_back(child, 0);
            met[child] = true;
        }
    }
    return order;
}

void set_mean_colours(CutGraph& cut) {
    constexpr int sweeps = 48;
    const std::vector<NodeId> order = masters_first(cut);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0;
        for (const NodeId id : order) {
            CutNode& node = cut.nodes[id];
            if (node.primitive || node.edges.empty()) continue;
            const MeanColour mean = mean_of(cut, node);
            change = std::max(change, glm::length(mean.fixed - node.mean.fixed));
            node.mean = mean;
        }
        if (change < 1e-7) break;
    }
}

void mark_solid(CutGraph& cut) {
    std::vector<std::vector<NodeId>> users(cut.nodes.size());
    std::vector<NodeId> found;
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        cut.nodes[id].solid = false;
        for (const CutEdge& edge : cut.nodes[id].edges)
            users[edge.child].push_back(id);
        if (cut.nodes[id].primitive || cut.nodes[id].cell) found.push_back(id);
    }
    while (!found.empty()) {
        const NodeId id = found.back();
        found.pop_back();
        if (cut.nodes[id].solid) continue;
        cut.nodes[id].solid = true;
        found.insert(found.end(), users[id].begin(), users[id].end());
    }
}

} // namespace graftal
