#include "compiler/detail/graph/detail_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/detail/graph/settle.h"
#include "compiler/graph/masters_first.h"

namespace graftal {

namespace {

MeanColour mean_of(const DetailGraph& cut, const DetailNode& node) {
    MeanColour sum{Rgb(0.0), 0};
    double weights = 0;
    for (const DetailEdge& edge : node.edges) {
        MeanColour mean = cut.nodes[edge.child].mean;
        if (edge.material) mean = {mean.over(cut.materials[*edge.material].rgb), 0};
        sum.fixed += edge.weight * edge.tint.over(mean.fixed);
        sum.open += edge.weight * (1 - edge.tint.alpha) * mean.open;
        weights += edge.weight;
    }
    return {sum.fixed / weights, sum.open / weights};
}

/// Shares, by material and of parts that inherit, in the visible area below a node, all together 1.
void set_shares(const DetailGraph& cut, const DetailNode& node, const std::vector<double>& shares,
                std::vector<double>& sum) {
    const std::size_t width = cut.materials.size() + 1;
    sum.assign(width, 0);
    double weights = 0;
    for (const DetailEdge& edge : node.edges) {
        weights += edge.weight;
        const double* const below = shares.data() + edge.child * width;
        for (std::size_t m = 0; m + 1 < width; ++m)
            sum[m] += edge.weight * below[m];
        sum[edge.material ? *edge.material : width - 1] += edge.weight * below[width - 1];
    }
    for (double& share : sum)
        share /= weights;
}

} // namespace

std::optional<MaterialId> most_seen(std::span<const double> shares, const std::vector<Material>& materials) {
    const auto most = static_cast<std::size_t>(std::ranges::max_element(shares) - shares.begin());
    if (most == materials.size()) return {};
    const Material& material = materials[most];
    if (material.is_painted() || material.is_transparent()) return {};
    return static_cast<MaterialId>(most);
}

std::vector<NodeId> masters_first(const DetailGraph& cut) {
    return masters_first(cut.nodes.size(),
                         [&](NodeId id) -> const std::vector<DetailEdge>& { return cut.nodes[id].edges; });
}

void set_mean_colours(DetailGraph& cut) {
    settle(cut, 48, 1e-7, [&](NodeId id) {
        const MeanColour before = std::exchange(cut.nodes[id].mean, mean_of(cut, cut.nodes[id]));
        const MeanColour& mean = cut.nodes[id].mean;
        return std::max(glm::length(mean.fixed - before.fixed), std::abs(mean.open - before.open));
    });
}

void set_finishes(DetailGraph& cut) {
    constexpr std::size_t most_shares = 8'000'000;
    const std::size_t width = cut.materials.size() + 1; // the last share is of what inherits
    if (cut.nodes.size() > most_shares / width) return;
    std::vector<double> shares(cut.nodes.size() * width, 0);
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        shares[id * width + cut.nodes[id].finish.value_or(static_cast<MaterialId>(width - 1))] = 1;
    std::vector<double> sum;
    settle(cut, 32, 1e-4, [&](NodeId id) {
        set_shares(cut, cut.nodes[id], shares, sum);
        double change = 0;
        for (std::size_t m = 0; m < width; ++m)
            change = std::max(change, std::abs(std::exchange(shares[id * width + m], sum[m]) - sum[m]));
        return change;
    });
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        if (!cut.nodes[id].edges.empty())
            cut.nodes[id].finish = most_seen({shares.data() + id * width, width}, cut.materials);
}

void mark_solid(DetailGraph& cut) {
    std::vector<std::vector<NodeId>> users(cut.nodes.size());
    std::vector<NodeId> found;
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        cut.nodes[id].solid = false;
        for (const DetailEdge& edge : cut.nodes[id].edges)
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
