#include "compiler/detail/graph/symmetry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr std::size_t max_checks = 20'000;

/// The cut as CongruentPairs knows it.
class CutShape {
  public:
    explicit CutShape(const DetailGraph& cut) : cut_(cut) {}

    std::size_t size() const { return cut_.nodes.size(); }
    const std::optional<Primitive>& primitive(NodeId id) const { return cut_.nodes[id].primitive; }
    const std::vector<DetailEdge>& edges(NodeId id) const { return cut_.nodes[id].edges; }
    const std::vector<DetailEdge>& stop_edges(NodeId id) const { return cut_.nodes[id].stop_edges; }

    bool alike(NodeId a, NodeId b) const {
        const DetailNode &x = cut_.nodes[a], &y = cut_.nodes[b];
        return x.primitive == y.primitive && x.combination == y.combination && x.cell == y.cell &&
               x.unending == y.unending && x.sealed == y.sealed && x.unbounded == y.unbounded &&
               x.cullable == y.cullable && x.terminal_px == y.terminal_px;
    }

    /// True for a cell, whose parts are no edges, and for operands, which take parts.
    bool fixed(NodeId id) const {
        const DetailNode& node = cut_.nodes[id];
        return node.sealed || node.cell || node.is_combined();
    }
    double radius(NodeId id) const { return cut_.nodes[id].ball.radius; }
    const Affine* proxy(NodeId id) const {
        const DetailNode& node = cut_.nodes[id];
        return node.stop_edges.empty() && node.cullable ? &node.node_from_proxy : nullptr;
    }

  private:
    const DetailGraph& cut_;
};

class Finder {
  public:
    explicit Finder(const DetailGraph& cut) : cut_(cut), shape_(cut), pairs_(shape_) {}

    Symmetry run() && {
        const auto count = static_cast<NodeId>(cut_.nodes.size());
        result_.representative.resize(count);
        result_.node_from_representative.resize(count);
        result_.pair.resize(count);
        std::map<std::tuple<std::size_t, long long, long long>, std::vector<NodeId>> representatives;
        for (NodeId id = 0; id < count; ++id) {
            auto& bucket = representatives[signature(id)];
            // Without checks left nothing joins, and the buckets may be long.
            if (out_of_checks() ||
                std::none_of(bucket.begin(), bucket.end(), [&](NodeId other) { return joins(other, id); })) {
                bucket.push_back(id);
                result_.representative[id] = id;
                result_.pair[id] = pairs_.congruent(id, id, Affine());
            }
        }
        result_.comparisons = pairs_.comparisons();
        result_.pairs = std::move(pairs_.pairs());
        return std::move(result_);
    }

  private:
    bool out_of_checks() const { return checks_ >= max_checks || pairs_.out_of_comparisons(); }

    static std::size_t number_of(const Primitive& primitive) {
        return static_cast<std::size_t>(primitive.kind()) * frustum_steps + primitive.steps();
    }

    /// Equal for congruent nodes. Their balls may differ, so sizes of balls are not in it.
    std::tuple<std::size_t, long long, long long> signature(NodeId id) const {
        const DetailNode& node = cut_.nodes[id];
        const auto rounded = [](double x) { return std::llround(std::log(std::max(x, 1e-300)) * 1e6); };
        double spread = 0;
        double stretch = 0;
        for (const DetailEdge& edge : node.edges) {
            spread += glm::distance(edge.node_from_child(pairs_.centre(edge.child)), pairs_.centre(id));
            stretch += edge.stretch;
        }
        // If points coincide up to rounding, their spread is noise.
        if (spread < 1e-6 * node.ball.radius) spread = 0;
        const std::size_t kind = node.cell        ? 2'000'000 + std::size_t{id} // like no other
                                 : node.primitive ? 1'000'000 + number_of(*node.primitive)
                                                  : 0;
        return {kind + node.edges.size(), rounded(stretch), rounded(spread)};
    }

    bool joins(NodeId representative, NodeId node) {
        for (const Mat3& linear : cube_symmetries()) {
            if (out_of_checks()) return false;
            ++checks_;
            const Affine moved = pairs_.moved(linear, representative, node);
            const std::size_t before = pairs_.pairs().size();
            const std::uint32_t pair = pairs_.congruent(representative, node, moved);
            if (pair != pairs_.no_pair) {
                result_.representative[node] = representative;
                result_.node_from_representative[node] = moved;
                result_.pair[node] = pair;
                return true;
            }
            pairs_.forget(before);
        }
        return false;
    }

    const DetailGraph& cut_;
    const CutShape shape_;
    CongruentPairs<CutShape> pairs_;
    Symmetry result_;
    std::size_t checks_ = 0;
};

} // namespace

Symmetry find_symmetry(DetailGraph& cut) {
    Symmetry symmetry = Finder(cut).run();
    // One ball a class, its smallest: congruent pieces then end at the same size.
    const auto take_smaller = [&](NodeId a, NodeId b, const Affine& a_from_b) {
        const Ball& ball = cut.nodes[b].ball;
        if (ball.radius < cut.nodes[a].ball.radius) cut.nodes[a].ball = {a_from_b(ball.centre), ball.radius};
    };
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        take_smaller(symmetry.representative[id], id, inverse(symmetry.node_from_representative[id]));
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        take_smaller(id, symmetry.representative[id], symmetry.node_from_representative[id]);
    return symmetry;
}

} // namespace graftal
