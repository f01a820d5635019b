#pragma once

// Check, for symmetry and halves, which objects are images of each other by an isometry. Candidates are
// checked coinductively: a pair is congruent if its edges can be paired so that all child pairs are. So
// cycles are no obstacle. Sound; it may miss congruences where several edges of a node coincide. Its effort
// is bounded.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/graph/graph.h"
#include "compiler/graph/masters_first.h"
#include "compiler/primitives/primitive.h"

namespace graftal {

/// The geometry of node `b` is that of node `a` moved by `b_from_a`; colours may differ. `edge` and
/// `stop_edge` pair the followed edges of a with those of b, `edge_pair` and `stop_pair` say which pair the
/// two children form.
struct NodePair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    Affine b_from_a;
    std::vector<std::uint32_t> edge;
    std::vector<std::uint32_t> edge_pair;
    std::vector<std::uint32_t> stop_edge;
    std::vector<std::uint32_t> stop_pair;
};

/// The 48 signed permutations of the axes, the identity first.
const std::vector<Mat3>& cube_symmetries();

/// Whether a map is orthogonal, as nearly as congruence asks for.
bool is_isometry(const Mat3& linear);

/// Whether the map takes one ellipsoid, the image of the unit ball, to the other.
bool takes_ellipsoid(const Affine& map, const Affine& from, const Affine& to);

/// `Shape` is what the check knows of a graph, its nodes numbered from 0:
///   size()                     how many nodes there are
///   primitive(node)            an optional Primitive
///   edges(node), stop_edges(node)   what can be asked for its size() and, by index, for an edge, which has
///                              `child`, `node_from_child`, `levels`, `material`, and its norm as `stretch`
///   alike(a, b)                whether nothing that is not in the edges tells the two apart
///   fixed(node)                whether it can only be paired with itself, as it lies
///   radius(node)               of a ball about it
///   proxy(node)                the ellipsoid that may be drawn in its place, as a pointer to its place; none
///                              where no proxy is drawn
template<typename Shape> class CongruentPairs {
  public:
    static constexpr std::uint32_t no_pair = UINT32_MAX;

    explicit CongruentPairs(const Shape& shape)
        : shape_(shape), centres_(equivariant_centres()), identity_pair_(shape.size(), no_pair) {}

    /// The pair, with all the pairs that it rests on, or no_pair. Each new pair is assumed while its children
    /// are paired; one failure fails them all: forget() them then.
    std::uint32_t congruent(std::uint32_t a, std::uint32_t b, const Affine& b_from_a) {
        const std::size_t before = pairs_.size();
        const std::uint32_t root = add_pair(a, b, b_from_a);
        for (std::size_t next = before; next < pairs_.size(); ++next) {
            if (!is_identity(pairs_[next]) && pairs_.size() - before > max_pairs_a_check) return no_pair;
            if (!match(next)) return no_pair;
        }
        return root;
    }

    void forget(std::size_t pairs_to_keep) {
        while (pairs_.size() > pairs_to_keep) {
            if (is_identity(pairs_.back())) {
                identity_pair_[pairs_.back().a] = no_pair;
            } else {
                known_.erase(keys_.back());
                keys_.pop_back();
            }
            pairs_.pop_back();
        }
    }

    /// The isometry with this linear part that takes the centre of `a` to that of `b`.
    Affine moved(const Mat3& linear, std::uint32_t a, std::uint32_t b) const {
        return {linear, centres_[b] - linear * centres_[a]};
    }

    Vec3 centre(std::uint32_t node) const { return centres_[node]; }
    const std::vector<NodePair>& pairs() const { return pairs_; }
    std::vector<NodePair>& pairs() { return pairs_; }
    /// Comparisons of two edges: the cost of all this.
    std::uint64_t comparisons() const { return comparisons_; }
    bool out_of_comparisons() const { return comparisons_ > max_comparisons; }

  private:
    static constexpr double tolerance = 1e-9;
    static constexpr std::size_t max_pairs_a_check = 4096;
    /// Pairs of edges that may be compared: a node of n of them has n squared.
    static constexpr std::uint64_t max_comparisons = 10'000'000;
    static constexpr std::uint64_t max_visits_for_centres = 20'000'000;

    /// Points that isometries of a node must respect: solutions of c_v = mean over edges of f_e(c_u).
    std::vector<Vec3> equivariant_centres() const {
        std::vector<Vec3> centre(shape_.size(), Vec3(0.0));
        std::uint64_t edges = 1;
        for (std::uint32_t id = 0; id < shape_.size(); ++id) {
            if (const auto& primitive = shape_.primitive(id))
                centre[id] = traits_of(*primitive).fixed_point(*primitive);
            edges += shape_.edges(id).size();
        }
        const std::vector<std::uint32_t> order = masters_first(
            shape_.size(), [&](std::uint32_t id) -> decltype(auto) { return shape_.edges(id); });
        const auto sweeps =
            static_cast<int>(std::clamp<std::uint64_t>(max_visits_for_centres / edges, 4, 200));
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            double change = 0;
            for (const std::uint32_t id : order) {
                const auto& edges_of_node = shape_.edges(id);
                if (shape_.primitive(id) || edges_of_node.size() == 0) continue;
                Vec3 mean(0.0);
                for (std::size_t i = 0; i < edges_of_node.size(); ++i)
                    mean += edges_of_node[i].node_from_child(centre[edges_of_node[i].child]);
                mean /= static_cast<double>(edges_of_node.size());
                change =
                    std::max(change, glm::distance(mean, centre[id]) / std::max(shape_.radius(id), 1e-300));
                centre[id] = mean;
            }
            if (change < 1e-14) break;
        }
        return centre;
    }

    static bool is_identity(const NodePair& pair) { return pair.a == pair.b && pair.b_from_a == Affine(); }

    using PairKey = std::tuple<std::uint32_t, std::uint32_t, std::array<long long, 12>>;

    static PairKey key(std::uint32_t a, std::uint32_t b, const Affine& b_from_a, double scale) {
        std::array<long long, 12> digits;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                digits[3 * column + row] = std::llround(b_from_a.linear[column][row] * 1e6);
        for (int row = 0; row < 3; ++row)
            digits[9 + row] = std::llround(b_from_a.translation[row] / std::max(scale, 1e-300) * 1e6);
        return {a, b, digits};
    }

    std::uint32_t add_pair(std::uint32_t a, std::uint32_t b, const Affine& b_from_a) {
        const double scale = shape_.radius(b);
        if (a == b && (b_from_a == Affine() || is_nearly_identity(b_from_a, scale))) return add_identity(a);
        const PairKey k = key(a, b, b_from_a, scale);
        if (const auto found = known_.find(k); found != known_.end()) return found->second;
        NodePair pair;
        pair.a = a;
        pair.b = b;
        pair.b_from_a = b_from_a;
        pairs_.push_back(std::move(pair));
        const auto index = static_cast<std::uint32_t>(pairs_.size() - 1);
        known_.emplace(k, index);
        keys_.push_back(k);
        return index;
    }

    /// True for a map that key() rounds to the identity.
    static bool is_nearly_identity(const Affine& a, double scale) {
        constexpr double half = 0.5e-6;
        for (int row = 0; row < 3; ++row)
            if (std::abs(a.translation[row]) >= half * std::max(scale, 1e-300)) return false;
        return largest_entry(a.linear - Mat3(1.0)) < half;
    }

    /// Every node has one: they must be cheap.
    std::uint32_t add_identity(std::uint32_t id) {
        std::uint32_t& index = identity_pair_[id];
        if (index != no_pair) return index;
        index = static_cast<std::uint32_t>(pairs_.size());
        pairs_.emplace_back();
        pairs_.back().a = pairs_.back().b = id;
        return index;
    }

    bool match(std::size_t index) {
        const NodePair pair = pairs_[index];
        if (!shape_.alike(pair.a, pair.b)) return false;
        if (is_identity(pair)) return match_itself(index);
        if (shape_.fixed(pair.a)) return false;
        if (const auto& primitive = shape_.primitive(pair.a))
            return traits_of(*primitive).keeps(*primitive, pair.b_from_a);
        // Proxies must be congruent too where they are drawn. The other node may draw none.
        const Affine *proxy = shape_.proxy(pair.a), *other = shape_.proxy(pair.b);
        if (proxy && (!other || !takes_ellipsoid(pair.b_from_a, *proxy, *other))) return false;
        NodePair matched = pair;
        if (!match_edges(shape_.edges(pair.a), shape_.edges(pair.b), pair.b_from_a, matched.edge,
                         matched.edge_pair) ||
            !match_edges(shape_.stop_edges(pair.a), shape_.stop_edges(pair.b), pair.b_from_a,
                         matched.stop_edge, matched.stop_pair))
            return false;
        pairs_[index] = std::move(matched);
        return true;
    }

    bool match_itself(std::size_t index) {
        NodePair matched = pairs_[index];
        const auto pair_off = [&](const auto& edges, std::vector<std::uint32_t>& edge,
                                  std::vector<std::uint32_t>& child) {
            for (std::uint32_t i = 0; i < edges.size(); ++i) {
                edge.push_back(i);
                child.push_back(add_pair(edges[i].child, edges[i].child, Affine()));
            }
        };
        pair_off(shape_.edges(matched.a), matched.edge, matched.edge_pair);
        pair_off(shape_.stop_edges(matched.a), matched.stop_edge, matched.stop_pair);
        pairs_[index] = std::move(matched);
        return true;
    }

    template<typename Edges>
    bool match_edges(const Edges& a, const Edges& b, const Affine& b_from_a, std::vector<std::uint32_t>& edge,
                     std::vector<std::uint32_t>& child) {
        if (a.size() != b.size()) return false;
        std::vector<bool> taken(b.size(), false);
        for (std::size_t i = 0; i < a.size(); ++i) {
            const auto& from = a[i];
            const Affine b_from_child_a = b_from_a * from.node_from_child;
            std::size_t found = b.size();
            Affine child_b_from_a;
            if (comparisons_ > max_comparisons) return false;
            for (std::size_t j = 0; j < b.size() && found == b.size(); ++j) {
                ++comparisons_;
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

    template<typename Edge> static bool compatible(const Edge& a, const Edge& b) {
        return a.levels == b.levels && a.material == b.material &&
               std::abs(a.stretch - b.stretch) <= tolerance * a.stretch &&
               !is_singular(b.node_from_child, 1e-9);
    }

    bool plausible(std::uint32_t a, std::uint32_t b, const Affine& b_from_a) const {
        if (const auto& primitive = shape_.primitive(b))
            return shape_.primitive(a) == primitive && traits_of(*primitive).keeps(*primitive, b_from_a);
        return !shape_.primitive(a) && is_isometry(b_from_a.linear) &&
               glm::distance(b_from_a(centres_[a]), centres_[b]) <= 1e-7 * shape_.radius(b);
    }

    const Shape& shape_;
    std::vector<Vec3> centres_;
    std::map<PairKey, std::uint32_t> known_;
    std::vector<PairKey> keys_; ///< by pair
    std::vector<NodePair> pairs_;
    std::vector<std::uint32_t> identity_pair_; ///< by node
    std::uint64_t comparisons_ = 0;
};

} // namespace graftal
