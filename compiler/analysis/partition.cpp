#include "compiler/analysis/partition.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace graftal {

namespace {

constexpr std::uint32_t max_rounds = 64;
constexpr std::uint32_t max_nodes_looked_at = 1'500'000; // in all rounds

/// A node as its label and edges show it, with the classes of the round before.
using Signature = std::vector<double>;

Signature signature(const LabelledGraph& graph, const std::vector<std::uint32_t>& class_of, std::uint32_t v) {
    std::vector<std::pair<double, double>> edges;
    for (const LabelledGraph::Edge& edge : graph.edges[v])
        edges.emplace_back(class_of[edge.to], edge.label);
    std::sort(edges.begin(), edges.end());
    Signature result{static_cast<double>(class_of[v]), graph.label[v]};
    for (const auto& [to, label] : edges) {
        result.push_back(to);
        result.push_back(label);
    }
    return result;
}

Partition every_node_by_itself(std::uint32_t n) {
    Partition partition;
    partition.class_of.resize(n);
    std::iota(partition.class_of.begin(), partition.class_of.end(), 0u);
    partition.representative = partition.class_of;
    return partition;
}

Partition refine(const LabelledGraph& graph, const Partition& coarse) {
    Partition fine;
    std::map<Signature, std::uint32_t> classes;
    for (std::uint32_t v = 0; v < graph.label.size(); ++v) {
        const auto [found, is_new] = classes.emplace(signature(graph, coarse.class_of, v), fine.size());
        if (is_new) fine.representative.push_back(v);
        fine.class_of.push_back(found->second);
    }
    return fine;
}

} // namespace

Partition group_equal_nodes(const LabelledGraph& graph) {
    const auto n = static_cast<std::uint32_t>(graph.label.size());
    Partition partition;
    partition.class_of.assign(n, 0);
    if (n > 0) partition.representative.push_back(0);
    const std::uint32_t rounds = std::clamp(max_nodes_looked_at / std::max(n, 1u), 4u, max_rounds);
    for (std::uint32_t round = 0; round < rounds; ++round) {
        Partition finer = refine(graph, partition);
        if (finer.size() == partition.size()) return finer;
        partition = std::move(finer);
    }
    return every_node_by_itself(n);
}

} // namespace graftal
