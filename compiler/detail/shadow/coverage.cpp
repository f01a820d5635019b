#include "compiler/detail/shadow/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/graph/congruence.h"
#include "compiler/detail/shadow/ellipsoid_fit.h"
#include "compiler/detail/shadow/lit_colours.h"
#include "compiler/detail/shadow/subtree.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// Parts of all subtrees together, and the least and most of one.
constexpr std::size_t all_pieces = 50'000, fewest_pieces = 8, most_pieces = 192;
/// A node of more instances keeps the ellipsoid in its box: such crowds are hardly culled as a whole.
constexpr std::size_t most_edges = 10'000;
/// Number of nodes above which shadows are taken along six directions.
constexpr std::size_t many_nodes = 3000;
constexpr std::size_t fine_factor = 12; ///< times as many parts, to see the end of a cycle
constexpr int most_rounds = 10;
/// Difference of growth_of_area() from 1 that counts as none.
constexpr double same_area = 1e-6;
/// A stand-in is full if its shadow has at least this share of that of the ellipsoid in the node's box.
constexpr double full_share = 0.5;

/// Fits the groups of congruent nodes, masters first.
class Fitter {
  public:
    Fitter(DetailGraph& cut, const Symmetry& symmetry, std::uint64_t most_bodies, WorkMeter* meter)
        : cut_(cut), symmetry_(symmetry), congruence_(find_congruence(cut, symmetry)),
          members_(cut.nodes.size()), seen_(cut.nodes.size()), shadowless_(cut.nodes.size(), false),
          ends_full_(cut.nodes.size(), false), most_draws_(most_bodies), meter_(meter) {
        place_.assign(cut.nodes.size(), nowhere);
        for (NodeId id = 0; id < cut.nodes.size(); ++id) {
            members_[congruence_.root[id]].push_back(id);
            box_half_.emplace_back();
            for (int k = 0; k < 3; ++k)
                box_half_.back()[k] = cut.nodes[id].node_from_proxy.linear[k][k];
        }
    }

    void run() {
        const Components components = components_of_groups();
        std::size_t groups = 0;
        const std::vector<bool> wanted = wanted_roots(components);
        for (const auto& members : components.members)
            groups += static_cast<std::size_t>(
                std::ranges::count_if(members, [&](NodeId id) { return wanted[id]; }));
        const std::size_t directions = groups > many_nodes ? 6 : 16;
        const std::size_t pieces = std::min<std::size_t>(all_pieces, most_draws_ / directions);
        effort_.pieces = std::clamp(pieces / std::max<std::size_t>(groups, 1), fewest_pieces, most_pieces);
        ShadowMeasurer measurer(cut_, directions);
        measurer_ = &measurer;
        const EllipsoidFit fit(measurer.along());
        fit_ = &fit;
        for (std::size_t c = 0; c < components.members.size(); ++c) {
            choose_roots(components.members[c], wanted);
            if (roots_.empty() || draws_left() == 0) continue;
            if (components.cyclic[c])
                fit_cycle();
            else
                fit_single(roots_.front());
        }
        draws_ = measurer.draws();
        weigh_edges();
        for (NodeId id = 0; id < cut_.nodes.size(); ++id) {
            const NodeId root = congruence_.root[id];
            cut_.nodes[id].shadowless = shadowless_[root] && !ends_full_[root];
        }
    }

    std::uint64_t draws() const { return draws_; }

  private:
    void choose_roots(const std::vector<NodeId>& members, const std::vector<bool>& wanted) {
        for (const NodeId root : roots_)
            place_[root] = nowhere;
        roots_.clear();
        for (const NodeId root : members) {
            if (!fittable(root) || !wanted[root]) continue;
            place_[root] = roots_.size();
            roots_.push_back(root);
        }
    }

    /// For the nodes that are drawn for the first time.
    std::uint64_t draws_left() const {
        const std::uint64_t drawn = measurer_->draws() - repeated_draws_;
        return most_draws_ - std::min(drawn, most_draws_);
    }

    bool fittable(NodeId id) const {
        const DetailNode& node = cut_.nodes[id];
        return !node.primitive && !node.is_combined() && !node.edges.empty() &&
               node.edges.size() <= most_edges && node.ball.radius > 0;
    }

    /// Roots whose proxies may be drawn, and those that these are measured by. A crowd of thousands of small
    /// things keeps the ellipsoid in its box, and none of them is ever drawn by another.
    std::vector<bool> wanted_roots(const Components& components) const {
        std::vector<bool> wanted(cut_.nodes.size(), false);
        for (NodeId id = 0; id < cut_.nodes.size(); ++id)
            if (cut_.nodes[id].cullable || cut_.nodes[id].unending) wanted[congruence_.root[id]] = true;
        wanted[congruence_.root[cut_.root]] = true;
        for (std::size_t c = components.members.size(); c-- > 0;) // users before their masters
            for (const NodeId id : components.members[c])
                if (wanted[id] && fittable(id))
                    for (const DetailEdge& edge : cut_.nodes[id].edges)
                        wanted[congruence_.root[edge.child]] = true;
        return wanted;
    }

    /// One object a group of congruent nodes; an edge where some node of the one leads to one of the other.
    Components components_of_groups() const {
        Graph groups;
        groups.objects.resize(cut_.nodes.size());
        groups.root = congruence_.root[cut_.root];
        for (NodeId id = 0; id < cut_.nodes.size(); ++id) {
            if (congruence_.root[id] != id) continue;
            std::vector<NodeId> masters;
            for (const DetailEdge& edge : cut_.nodes[id].edges)
                masters.push_back(congruence_.root[edge.child]);
            std::sort(masters.begin(), masters.end());
            masters.erase(std::unique(masters.begin(), masters.end()), masters.end());
            for (const NodeId master : masters)
                groups.objects[id].instances.push_back({master, {}, {}, {}, {}});
        }
        Components components = strong_components(groups);
        for (auto& members : components.members)
            std::erase_if(members, [&](NodeId id) { return congruence_.root[id] != id; });
        return components;
    }

    SubtreeShadow measure(NodeId root, const Effort& effort, bool ended = false) {
        const std::uint64_t before = measurer_->draws();
        SubtreeShadow measured = measurer_->measure(root, effort, ended);
        if (meter_) meter_->add(measurer_->draws() - before, StagePrice::body);
        return measured;
    }

    void fit_single(NodeId root) {
        if (cut_.nodes[root].unending && !reaches_area(root)) {
            shadowless_[root] = true;
            ends_full_[root] =
                ends_full(root) && std::ranges::all_of(cut_.nodes[root].edges, [&](const DetailEdge& edge) {
                    return ends_full_[congruence_.root[edge.child]];
                });
            return;
        }
        take(root, measure(root, effort_), 1);
    }

    /// Whether something it holds, cycles aside, has a shadow.
    bool reaches_area(NodeId root) const {
        for (const DetailEdge& edge : cut_.nodes[root].edges) {
            const NodeId master = congruence_.root[edge.child];
            if (place_[master] == nowhere && !shadowless_[master]) return true;
        }
        return false;
    }

    /// Whether what is drawn of a shadowless node where it is cut covers about as much as its ellipsoid does:
    /// a full terminal, say, not a line along it. A node that is not cullable is never cut itself.
    bool ends_full(NodeId root) {
        const DetailNode& node = cut_.nodes[root];
        if (!node.cullable) return true;
        if (node.stop_edges.empty() || is_flat(node)) return false;
        double area = 0;
        for (const Vec3& direction : measurer_->along())
            area += projected_area(node.node_from_proxy, direction);
        area /= static_cast<double>(measurer_->along().size()) * node.ball.radius * node.ball.radius;
        return measure(root, effort_, true).mean >= full_share * area;
    }

    void fit_cycle() {
        const double growth = growth_of_area();
        const bool grows = growth > 1 + same_area;
        if (!grows &&
            std::none_of(roots_.begin(), roots_.end(), [&](NodeId id) { return reaches_area(id); })) {
            for (const NodeId root : roots_) {
                shadowless_[root] = true;
                ends_full_[root] = growth > 1 - same_area && ends_full(root);
            }
            return;
        }
        const std::uint64_t begin = measurer_->draws();
        // Half of what the cycles before have left, and half of that for either step.
        const std::uint64_t allowed = (most_draws_ - repeated_draws_) / 4;
        const std::uint64_t round_draws = go_round(allowed);
        if (grows) fit_together(allowed, round_draws);
        repeated_draws_ = std::min(repeated_draws_ + measurer_->draws() - begin - round_draws, most_draws_);
    }

    /// Measures the nodes of a cycle by each other's proxies until these stay as they are. Returns what one
    /// round draws.
    std::uint64_t go_round(std::uint64_t allowed) {
        const std::uint64_t begin = measurer_->draws(), first_round = draws_left();
        std::uint64_t round_draws = 0;
        std::vector<double> mean(roots_.size(), 0);
        for (int round = 0; round < most_rounds; ++round) {
            double change = 0;
            for (std::size_t i = 0; i < roots_.size(); ++i) {
                if (round == 0 && measurer_->draws() - begin > first_round) break;
                const SubtreeShadow measured = measure(roots_[i], effort_);
                take(roots_[i], measured, 1);
                change =
                    std::max(change, std::abs(measured.mean - mean[i]) / std::max(measured.mean, 1e-300));
                mean[i] = measured.mean;
            }
            const std::uint64_t draws = measurer_->draws() - begin;
            if (round == 0) round_draws = draws;
            if (change < 0.01 || draws > allowed) break;
        }
        return round_draws;
    }

    /// Proxies side by side cover more than one alone would say, they reach into each other's gaps: scaled,
    /// all alike, so that some hundred of them cover what the limit does. As well as is allowed.
    void fit_together(std::uint64_t allowed, std::uint64_t round_draws) {
        const std::uint64_t rounds = allowed / std::max<std::uint64_t>(round_draws, 1) / 2;
        if (rounds < 4) return;
        Effort fine{std::min(fine_factor * effort_.pieces, fine_factor * all_pieces / (8 * roots_.size())),
                    Effort::fine_grid};
        fine.pieces = std::clamp<std::uint64_t>(fine.pieces, effort_.pieces, rounds * effort_.pieces);
        double limit = 0;
        std::vector<SubtreeShadow> measured;
        for (const NodeId root : roots_)
            measured.push_back(measure(root, fine));
        for (const SubtreeShadow& m : measured)
            limit += m.mean;
        const auto together = [&](double scale) {
            for (std::size_t i = 0; i < roots_.size(); ++i)
                take(roots_[i], measured[i], scale);
            double sum = 0;
            for (const NodeId root : roots_)
                sum += measure(root, {effort_.pieces, Effort::fine_grid}).mean;
            return sum;
        };
        double low = 0.5, high = 1.5;
        for (std::uint64_t step = 1; step < std::min<std::uint64_t>(rounds, 7); ++step) {
            const double middle = 0.5 * (low + high);
            (together(middle) < limit ? low : high) = middle;
        }
        together(0.5 * (low + high));
    }

    /// The factor by which the sum of the parts' shadows grows, a level, going round the cycle: above 1 for
    /// dimensions above 2.
    double growth_of_area() const {
        std::vector<std::vector<std::pair<std::size_t, double>>> factors(roots_.size());
        for (std::size_t i = 0; i < roots_.size(); ++i)
            for (const DetailEdge& edge : cut_.nodes[roots_[i]].edges) {
                const std::size_t at = place_[congruence_.root[edge.child]];
                if (at == nowhere) continue;
                const Vec3 s = singular_values(edge.node_from_child.linear);
                factors[i].emplace_back(at, (s.x * s.y + s.y * s.z + s.z * s.x) / 3);
            }
        // Powers of I + M converge where those of M may take turns.
        std::vector<double> area(roots_.size(), 1), next(roots_.size());
        double growth = 1;
        for (int step = 0; step < 200; ++step) {
            for (std::size_t i = 0; i < roots_.size(); ++i) {
                next[i] = area[i];
                for (const auto& [child, factor] : factors[i])
                    next[i] += factor * area[child];
            }
            const double before = std::exchange(growth, *std::max_element(next.begin(), next.end()));
            if (std::abs(growth - before) < 1e-12 * growth && step > 20) break;
            for (std::size_t i = 0; i < roots_.size(); ++i)
                area[i] = next[i] / growth;
        }
        return growth - 1;
    }

    /// Makes what was measured the proxy of the root and of all that are congruent to it.
    void take(NodeId root, const SubtreeShadow& measured, double scale) {
        if (!(measured.mean > 0)) return;
        const Ball& ball = cut_.nodes[root].ball;
        Eigen::Matrix3d form = fit_->form(measured.area);
        Vec3 centre = measured.centre;
        make_symmetric(congruence_.symmetries[root], form, centre);
        const Mat3 linear = fit_->ellipsoid(form, measured.mean, box_half_[root] / ball.radius);
        const Affine proxy{scale * ball.radius * linear, centre};
        for (const NodeId member : members_[root])
            cut_.nodes[member].node_from_proxy = congruence_.node_from_root[member] * proxy;
        seen_[root] = measured.seen;
    }

    /// The samples of the shadows know nothing of the subtree's symmetries, but meshes rely on them.
    static void make_symmetric(const std::vector<Affine>& symmetries, Eigen::Matrix3d& form, Vec3& centre) {
        const int sweeps = symmetries.size() > 16 ? 24 : 96;
        for (int sweep = 0; sweep < sweeps && !symmetries.empty(); ++sweep)
            for (const Affine& symmetry : symmetries) {
                Eigen::Matrix3d turn;
                for (int column = 0; column < 3; ++column)
                    for (int row = 0; row < 3; ++row)
                        turn(row, column) = symmetry.linear[column][row];
                form = 0.5 * (form + turn * form * turn.transpose()).eval();
                centre = 0.5 * (centre + symmetry(centre));
            }
    }

    /// Gives the visible weights of a root's edges to the edges that they are paired with.
    void weigh_edges() {
        for (const std::uint32_t p : congruence_.order) {
            const NodePair& pair = symmetry_.pairs[p];
            std::vector<double>&a = seen_[pair.a], &b = seen_[pair.b];
            if (a.empty() == b.empty() || pair.edge.size() != std::max(a.size(), b.size())) continue;
            if (b.empty()) {
                b.resize(a.size());
                for (std::size_t i = 0; i < a.size(); ++i)
                    b[pair.edge[i]] = a[i];
            } else {
                a.resize(b.size());
                for (std::size_t i = 0; i < b.size(); ++i)
                    a[i] = b[pair.edge[i]];
            }
        }
        for (NodeId id = 0; id < cut_.nodes.size(); ++id) {
            std::vector<DetailEdge>& edges = cut_.nodes[id].edges;
            if (seen_[id].size() != edges.size()) continue;
            for (std::size_t i = 0; i < edges.size(); ++i)
                edges[i].weight = std::max(seen_[id][i], 1e-300);
        }
    }

    DetailGraph& cut_;
    const Symmetry& symmetry_;
    Congruence congruence_;
    std::vector<std::vector<NodeId>> members_; ///< by root
    std::vector<Vec3> box_half_;               ///< by node
    std::vector<std::vector<double>> seen_;    ///< by node, then by edge
    std::vector<bool> shadowless_;             ///< by root
    std::vector<bool> ends_full_;              ///< by root: of shadowless sets of dimension 2
    Effort effort_{most_pieces, Effort::coarse_grid};
    const std::uint64_t most_draws_; ///< once for each node, and again for cycles
    std::uint64_t draws_ = 0, repeated_draws_ = 0;
    std::vector<NodeId> roots_;      ///< of the component under way
    std::vector<std::size_t> place_; ///< by node: among them, or nowhere
    static constexpr std::size_t nowhere = SIZE_MAX;
    ShadowMeasurer* measurer_ = nullptr;
    const EllipsoidFit* fit_ = nullptr;
    WorkMeter* meter_ = nullptr;
};

} // namespace

std::uint64_t fit_proxies(DetailGraph& cut, const Symmetry& symmetry, std::uint64_t most_bodies,
                          WorkMeter* meter) {
    Fitter fitter(cut, symmetry, most_bodies, meter);
    fitter.run();
    set_mean_colours(cut);
    set_finishes(cut);
    set_lit_colours(cut);
    return fitter.draws();
}

bool is_flat(const DetailNode& node) {
    // The ellipsoid in the box, which is a fiftieth as thick as long at least.
    const Vec3 axes = singular_values(node.node_from_proxy.linear); // the ellipsoid may be turned
    return axes.z <= 0.021 * axes.x;
}

} // namespace graftal
