#include "compiler/detail/symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/analysis/bounding.h"

namespace graftal {

namespace {

constexpr double tolerance = 1e-9;
constexpr std::size_t max_pairs_a_check = 4096;
constexpr std::size_t max_checks = 20'000;
/// Pairs of edges that may be compared: a node of n of them has n squared.
constexpr std::uint64_t max_comparisons = 10'000'000;
constexpr std::uint64_t max_visits_for_centres = 20'000'000;
constexpr std::uint32_t no_pair = UINT32_MAX;

/// The 48 signed permutations of the axes, the identity first.
std::vector<Mat3> cube_symmetries() {
    std::vector<Mat3> all;
    std::array<int, 3> order = {0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Mat3 m(0.0);
            for (int column = 0; column < 3; ++column)
                m[column][order[column]] = (signs >> column & 1) ? -1.0 : 1.0;
            all.push_back(m);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
}

bool near_zero(const Mat3& m, double scale) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(m[column][row]) > tolerance * scale) return false;
    return true;
}

bool fixes_y_axis(const Mat3& m) {
    return std::abs(m[1][0]) < tolerance && std::abs(m[1][2]) < tolerance && std::abs(m[0][1]) < tolerance &&
           std::abs(m[2][1]) < tolerance;
}

bool is_orthogonal(const Mat3& m) {
    return near_zero(glm::transpose(m) * m - Mat3(1.0), 1);
}

/// Whether the map takes the canonical primitive onto itself.
bool preserves(PrimitiveKind kind, const Affine& a) {
    if (kind == PrimitiveKind::triangle) {
        const std::array<Vec3, 3> corners = triangle_corners();
        for (const Vec3& corner : corners) {
            const bool lands = std::any_of(corners.begin(), corners.end(), [&](const Vec3& other) {
                return glm::distance(a(corner), other) < tolerance;
            });
            if (!lands) return false;
        }
        return true;
    }
    if (glm::length(a.translation) > tolerance || !is_orthogonal(a.linear)) return false;
    switch (kind) {
    case PrimitiveKind::sphere:
        return true;
    case PrimitiveKind::cube:
        // Orthogonal with columns of 1-norm 1: a signed permutation.
        return std::abs(glm::dot(glm::abs(a.linear[0]), Vec3(1.0)) - 1) < tolerance &&
               std::abs(glm::dot(glm::abs(a.linear[1]), Vec3(1.0)) - 1) < tolerance;
    case PrimitiveKind::torus:
        return fixes_y_axis(a.linear);
    default:
        return fixes_y_axis(a.linear) && a.linear[1][1] > 0;
    }
}

/// Points that isometries of a node must respect: solutions of c_v = mean over edges of f_e(c_u).
std::vector<Vec3> equivariant_centres(const CutGraph& cut) {
    std::vector<Vec3> centre(cut.nodes.size(), Vec3(0.0));
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        if (const auto kind = cut.nodes[id].primitive;
            kind && (*kind == PrimitiveKind::cylinder || *kind == PrimitiveKind::cone ||
                     family_of(*kind) == PrimitiveKind::frustum))
            centre[id] = Vec3(0, 0.5, 0);
    const std::vector<NodeId> order = masters_first(cut);
    std::uint64_t edges = 1;
    for (const CutNode& node : cut.nodes)
        edges += node.edges.size();
    const auto sweeps = static_cast<int>(std::clamp<std::uint64_t>(max_visits_for_centres / edges, 4, 200));
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0;
        for (const NodeId id : order) {
            const CutNode& node = cut.nodes[id];
            if (node.primitive || node.edges.empty()) continue;
            Vec3 mean(0.0);
            for (const CutEdge& edge : node.edges)
                mean += edge.node_from_child(centre[edge.child]);
            mean /= static_cast<double>(node.edges.size());
            change = std::max(change, glm::distance(mean, centre[id]) / std::max(node.ball.radius, 1e-300));
            centre[id] = mean;
        }
        if (change < 1e-14) break;
    }
    return centre;
}

class Finder {
  public:
    explicit Finder(const CutGraph& cut)
        : cut_(cut), centres_(equivariant_centres(cut)), identity_pair_(cut.nodes.size(), no_pair) {}

    Symmetry find() {
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
                result_.pair[id] = identity_pair(id);
            }
        }
        return std::move(result_);
    }

    /// For each edge whether it belongs to the first half; empty if the node has no halves.
    std::vector<bool> halves(NodeId id) {
        const CutNode& node = cut_.nodes[id];
        if (!node.unending || node.sealed || node.edges.size() < 4 || node.edges.size() % 2 != 0) return {};
        for (const Mat3& linear : candidates()) {
            if (linear * linear != Mat3(1.0) || linear == Mat3(1.0) || out_of_checks()) continue;
            ++checks_;
            const std::size_t before = result_.pairs.size();
            const Affine moved{linear, centres_[id] - linear * centres_[id]};
            const std::uint32_t pair = congruent(id, id, moved);
            std::vector<bool> first(node.edges.size(), true);
            bool found = pair != no_pair;
            for (std::uint32_t i = 0; found && i < first.size(); ++i) {
                const std::uint32_t twin = result_.pairs[pair].edge[i];
                found = twin != i && result_.pairs[pair].edge[twin] == i;
                if (twin < i) first[i] = false;
            }
            forget(before);
            if (found) return first;
        }
        return {};
    }

  private:
    static const std::vector<Mat3>& candidates() {
        static const std::vector<Mat3> all = cube_symmetries();
        return all;
    }

    bool out_of_checks() const { return checks_ >= max_checks || result_.comparisons > max_comparisons; }

    static bool is_identity(const NodePair& pair) { return pair.a == pair.b && pair.b_from_a == Affine(); }

    void forget(std::size_t pairs_to_keep) {
        while (result_.pairs.size() > pairs_to_keep) {
            if (is_identity(result_.pairs.back())) {
                identity_pair_[result_.pairs.back().a] = no_pair;
            } else {
                known_.erase(keys_.back());
                keys_.pop_back();
            }
            result_.pairs.pop_back();
        }
    }

    /// Equal for congruent nodes. Balls are not: the search for them is no more symmetric than it must be.
    std::tuple<std::size_t, long long, long long> signature(NodeId id) const {
        const CutNode& node = cut_.nodes[id];
        const auto rounded = [](double x) { return std::llround(std::log(std::max(x, 1e-300)) * 1e6); };
        double spread = 0;
        double stretch = 0;
        for (const CutEdge& edge : node.edges) {
            spread += glm::distance(edge.node_from_child(centres_[edge.child]), centres_[id]);
            stretch += edge.stretch;
        }
        // If points coincide up to rounding, their spread is noise.
        if (spread < 1e-6 * node.ball.radius) spread = 0;
        const std::size_t kind = node.cell        ? 2'000'000 + std::size_t{id} // like no other
                                 : node.primitive ? 1'000'000 + static_cast<std::size_t>(*node.primitive)
                                                  : 0;
        return {kind + node.edges.size(), rounded(stretch), rounded(spread)};
    }

    bool joins(NodeId representative, NodeId node) {
        for (const Mat3& linear : candidates()) {
            if (out_of_checks()) return false;
            ++checks_;
            const Affine moved{linear, centres_[node] - linear * centres_[representative]};
            const std::size_t before = result_.pairs.size();
            const std::uint32_t pair = congruent(representative, node, moved);
            if (pair != no_pair) {
                result_.representative[node] = representative;
                result_.node_from_representative[node] = moved;
                result_.pair[node] = pair;
                return true;
            }
            forget(before);
        }
        return false;
    }

    using PairKey = std::tuple<NodeId, NodeId, std::array<long long, 12>>;

    static PairKey key(NodeId a, NodeId b, const Affine& b_from_a, double scale) {
        std::array<long long, 12> digits;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                digits[3 * column + row] = std::llround(b_from_a.linear[column][row] * 1e6);
        for (int row = 0; row < 3; ++row)
            digits[9 + row] = std::llround(b_from_a.translation[row] / std::max(scale, 1e-300) * 1e6);
        return {a, b, digits};
    }

    std::uint32_t add_pair(NodeId a, NodeId b, const Affine& b_from_a) {
        const double scale = cut_.nodes[b].ball.radius;
        if (a == b && (b_from_a == Affine() || is_nearly_identity(b_from_a, scale))) return add_identity(a);
        const PairKey k = key(a, b, b_from_a, scale);
        if (const auto found = known_.find(k); found != known_.end()) return found->second;
        NodePair pair;
        pair.a = a;
        pair.b = b;
        pair.b_from_a = b_from_a;
        result_.pairs.push_back(std::move(pair));
        const auto index = static_cast<std::uint32_t>(result_.pairs.size() - 1);
        known_.emplace(k, index);
        keys_.push_back(k);
        return index;
    }

    /// As key() rounds.
    static bool is_nearly_identity(const Affine& a, double scale) {
        constexpr double half = 0.5e-6;
        for (int row = 0; row < 3; ++row)
            if (std::abs(a.translation[row]) >= half * std::max(scale, 1e-300)) return false;
        return largest_entry(a.linear - Mat3(1.0)) < half;
    }

    /// Every node has one: they must be cheap.
    std::uint32_t add_identity(NodeId id) {
        std::uint32_t& index = identity_pair_[id];
        if (index != no_pair) return index;
        index = static_cast<std::uint32_t>(result_.pairs.size());
        result_.pairs.emplace_back();
        result_.pairs.back().a = result_.pairs.back().b = id;
        return index;
    }

    std::uint32_t identity_pair(NodeId id) { return congruent(id, id, Affine()); }

    /// The pair, with all the pairs that it rests on, or no_pair. Each new pair is assumed while its children
    /// are paired; one failure fails them all.
    std::uint32_t congruent(NodeId a, NodeId b, const Affine& b_from_a) {
        const std::size_t before = result_.pairs.size();
        const std::uint32_t root = add_pair(a, b, b_from_a);
        for (std::size_t next = before; next < result_.pairs.size(); ++next) {
            if (!is_identity(result_.pairs[next]) && result_.pairs.size() - before > max_pairs_a_check)
                return no_pair;
            if (!match(next)) return no_pair;
        }
        return root;
    }

    bool match(std::size_t index) {
        const NodePair pair = result_.pairs[index];
        const CutNode& a = cut_.nodes[pair.a];
        const CutNode& b = cut_.nodes[pair.b];
        if (a.primitive != b.primitive || a.cell != b.cell || a.unending != b.unending ||
            a.sealed != b.sealed || a.unbounded != b.unbounded || a.cullable != b.cullable ||
            a.terminal_px != b.terminal_px)
            return false;
        if (is_identity(pair)) return match_itself(index);
        if (a.sealed) return false;
        if (a.primitive) return preserves(*a.primitive, pair.b_from_a);
        // Proxies must be congruent too where they are drawn.
        if (a.stop_edges.empty() && a.cullable && !proxy_agrees(a, b, pair.b_from_a)) return false;
        NodePair matched = pair;
        if (!match_edges(a.edges, b.edges, pair.b_from_a, matched.edge, matched.edge_pair) ||
            !match_edges(a.stop_edges, b.stop_edges, pair.b_from_a, matched.stop_edge, matched.stop_pair))
            return false;
        result_.pairs[index] = std::move(matched);
        return true;
    }

    bool match_itself(std::size_t index) {
        NodePair matched = result_.pairs[index];
        const CutNode& node = cut_.nodes[matched.a];
        const auto pair_off = [&](const std::vector<CutEdge>& edges, std::vector<std::uint32_t>& edge,
                                  std::vector<std::uint32_t>& child) {
            for (std::uint32_t i = 0; i < edges.size(); ++i) {
                edge.push_back(i);
                child.push_back(add_pair(edges[i].child, edges[i].child, Affine()));
            }
        };
        pair_off(node.edges, matched.edge, matched.edge_pair);
        pair_off(node.stop_edges, matched.stop_edge, matched.stop_pair);
        result_.pairs[index] = std::move(matched);
        return true;
    }

    bool match_edges(const std::vector<CutEdge>& a, const std::vector<CutEdge>& b, const Affine& b_from_a,
                     std::vector<std::uint32_t>& edge, std::vector<std::uint32_t>& child) {
        if (a.size() != b.size()) return false;
        std::vector<bool> taken(b.size(), false);
        for (const CutEdge& from : a) {
            const Affine b_from_child_a = b_from_a * from.node_from_child;
            std::size_t found = b.size();
            Affine child_b_from_a;
            if (result_.comparisons > max_comparisons) return false;
            for (std::size_t j = 0; j < b.size() && found == b.size(); ++j) {
                ++result_.comparisons;
                if (taken[j] || !compatible(from, b[j])) continue;
                child_b_from_a = inverse(b[j].node_from_child) * b_from_child_a;
                if (plausible(from.child, b[j].child, child_b_from_a)) found = j;
            }
            if (found == b.size()) return false;
            taken[found] = true;
            edge.push_back(static_cast<std::uint32_t>(found));
            child.push_back(add_pair(from.child, b[found].child, child_b_from_a));
        }
        return true;
    }

    static bool compatible(const CutEdge& a, const CutEdge& b) {
        return a.levels == b.levels && a.material == b.material &&
               std::abs(a.stretch - b.stretch) <= tolerance * a.stretch &&
               !is_singular(b.node_from_child, 1e-9);
    }

    bool plausible(NodeId a, NodeId b, const Affine& b_from_a) const {
        const CutNode& node = cut_.nodes[b];
        if (node.primitive)
            return cut_.nodes[a].primitive == node.primitive && preserves(*node.primitive, b_from_a);
        return !cut_.nodes[a].primitive && is_orthogonal(b_from_a.linear) &&
               glm::distance(b_from_a(centres_[a]), centres_[b]) <= 1e-7 * node.ball.radius;
    }

    static bool proxy_agrees(const CutNode& a, const CutNode& b, const Affine& b_from_a) {
        const Affine moved = b_from_a * a.node_from_proxy;
        const Mat3 x = moved.linear * glm::transpose(moved.linear);
        const Mat3 y = b.node_from_proxy.linear * glm::transpose(b.node_from_proxy.linear);
        const double size = norm(y);
        return near_zero(x - y, 10 * size) &&
               glm::distance(moved.translation, b.node_from_proxy.translation) <= 1e-7 * std::sqrt(size);
    }

    const CutGraph& cut_;
    std::vector<Vec3> centres_;
    std::map<PairKey, std::uint32_t> known_;
    std::vector<PairKey> keys_; ///< by pair
    Symmetry result_;
    std::vector<std::uint32_t> identity_pair_; ///< by node
    std::size_t checks_ = 0;
};

} // namespace

void split_into_halves(CutGraph& cut) {
    std::vector<std::vector<bool>> halves;
    Finder finder(cut);
    const auto count = static_cast<NodeId>(cut.nodes.size());
    for (NodeId id = 0; id < count; ++id)
        halves.push_back(finder.halves(id));
    for (NodeId id = 0; id < count; ++id) {
        if (halves[id].empty()) continue;
        std::vector<CutEdge> both;
        for (const bool first : {true, false}) {
            CutNode half = cut.nodes[id];
            half.edges.clear();
            half.stop_edges.clear();
            half.terminal = false;
            half.terminal_px = 0;
            half.cullable = false; // the whole node is culled or cut, never a half
            for (std::size_t i = 0; i < halves[id].size(); ++i)
                if (halves[id][i] == first) half.edges.push_back(cut.nodes[id].edges[i]);
            both.push_back({static_cast<NodeId>(cut.nodes.size()), {}, {}, {}, 0, 1, 1, true});
            cut.nodes.push_back(std::move(half));
        }
        cut.nodes[id].edges = std::move(both);
    }
}

Symmetry find_symmetry(CutGraph& cut) {
    Symmetry symmetry = Finder(cut).find();
    // One ball a class, its smallest: congruent pieces then end at the same size.
    const auto take_smaller = [&](NodeId to, NodeId from, const Affine& to_from_from) {
        const Ball& ball = cut.nodes[from].ball;
        if (ball.radius < cut.nodes[to].ball.radius)
            cut.nodes[to].ball = {to_from_from(ball.centre), ball.radius};
    };
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        take_smaller(symmetry.representative[id], id, inverse(symmetry.node_from_representative[id]));
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        take_smaller(id, symmetry.representative[id], symmetry.node_from_representative[id]);
    return symmetry;
}

} // namespace graftal
