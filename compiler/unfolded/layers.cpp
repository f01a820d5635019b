#include "compiler/unfolded/layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/graph/piece_kind.h"

namespace graftal {

namespace {

constexpr std::size_t most_nodes = 5000;

/// Largest scale of the last level, relative to the root.
double last_scale(const DetailGraph& cut, std::uint32_t root_steps) {
    double largest = 0;
    for (const DetailNode& node : cut.nodes)
        for (const DetailEdge& edge : node.edges)
            if (edge.levels > 0) largest = std::max(largest, edge.stretch);
    return std::pow(largest, root_steps);
}

class Layering {
  public:
    explicit Layering(const DetailGraph& cut) : cut_(cut) {}

    LayeredGraph run(std::uint32_t root_steps) {
        result_.cut.root = copy_of(cut_.root, root_steps);
        // Copies are made as they are met; the list grows meanwhile.
        for (std::size_t i = 0; i < result_.source.size(); ++i)
            fill(i);
        return std::move(result_);
    }

  private:
    NodeId copy_of(NodeId node, std::uint32_t steps) {
        const PieceKind kind = without_idle_levels(cut_, {node, steps});
        const auto [place, added] = copies_.emplace(kind, static_cast<NodeId>(result_.source.size()));
        if (added) {
            result_.source.push_back(node);
            steps_.push_back(kind.steps);
        }
        return place->second;
    }

    void fill(std::size_t copy) {
        DetailNode node = cut_.nodes[result_.source[copy]];
        const std::uint32_t steps = steps_[copy];
        if (node.unending && steps == 0 && !node.unbounded && !node.sealed) node.edges.clear();
        for (std::vector<DetailEdge>* edges : {&node.edges, &node.stop_edges})
            for (DetailEdge& edge : *edges)
                edge.child = copy_of(edge.child, steps >= edge.levels ? steps_below(steps, edge) : 0);
        if (node.cell) node.cell = copy_of(node.cell);
        result_.cut.nodes.push_back(std::move(node));
    }

    /// A cell of the same parts, of the copies of their primitives.
    std::shared_ptr<const EdgeCell> copy_of(const std::shared_ptr<const EdgeCell>& cell) {
        std::shared_ptr<const CellSource>& source = sources_[cell->source.get()];
        if (!source) {
            CellSource copy = *cell->source;
            for (std::size_t shape = 0; shape < copy.child.size(); ++shape)
                if (const auto& primitive = cut_.nodes[copy.child[shape]].primitive;
                    primitive && RunShape(*primitive).index() == shape)
                    copy.child[shape] = copy_of(copy.child[shape], 0);
            source = std::make_shared<const CellSource>(std::move(copy));
        }
        EdgeCell copy = *cell;
        copy.source = source;
        return std::make_shared<const EdgeCell>(std::move(copy));
    }

    const DetailGraph& cut_;
    LayeredGraph result_;
    std::vector<std::uint32_t> steps_; ///< by copy
    std::unordered_map<PieceKind, NodeId, PieceKindHash> copies_;
    std::map<const CellSource*, std::shared_ptr<const CellSource>> sources_;
};

} // namespace

LayeredGraph layered(const DetailGraph& cut, std::uint32_t root_steps) {
    constexpr double all_but_the_limit = 0.05;
    const bool few = root_steps < most_nodes && cut.nodes.size() * (root_steps + 1) <= most_nodes;
    if (few && last_scale(cut, root_steps) > all_but_the_limit) return Layering(cut).run(root_steps);
    LayeredGraph whole{cut, std::vector<NodeId>(cut.nodes.size())};
    std::iota(whole.source.begin(), whole.source.end(), NodeId{0});
    return whole;
}

} // namespace graftal
