#include "compiler/detail/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/congruence.h"
#include "compiler/detail/ellipsoid_fit.h"
#include "compiler/detail/shadow.h"
#include "compiler/graph/walk.h"

namespace graftal {

namespace {

using std::numbers::pi;

/// How much is spent on a node.
struct Effort {
    std::size_t pieces;
    int grid;
};

/// Parts of all subtrees together, and the least and most of one.
constexpr std::size_t all_pieces = 50'000, fewest_pieces = 8, most_pieces = 192;
/// A node of more instances keeps the ellipsoid in its box: such crowds are hardly culled as a whole.
constexpr std::size_t most_edges = 10'000;
/// With more nodes than this, shadows are taken along six directions.
constexpr std::size_t many_nodes = 3000;
constexpr int coarse_grid = 64, fine_grid = 128;
constexpr std::size_t fine_factor = 12; ///< so many more parts to see what a cycle ends in
constexpr int most_rounds = 10;
/// Bodies that may be drawn for cycles, besides once for each node. Any scene of ours needs less than a
/// tenth.
constexpr std::uint64_t most_repeated_draws = 4'000'000;
/// How much more a measurement may cost for a primitive of several bodies.
constexpr std::size_t bodies_a_piece = 4;

/// The axes of an icosahedron, then those of a dodecahedron, turned away from the coordinate axes and
/// towards all sides alike.
std::vector<Vec3> directions(std::size_t count) {
    const double g = std::numbers::phi;
    std::vector<Vec3> axes;
    for (const double s : {1.0, -1.0})
        axes.insert(axes.end(), {{0, s, g}, {g, 0, s}, {s, g, 0}});
    for (const double s : {1.0, -1.0}) {
        axes.insert(axes.end(), {{s, 1, 1}, {-s, s, -1}});
        axes.insert(axes.end(), {{0, s / g, g}, {g, 0, s / g}, {s / g, g, 0}});
    }
    axes.resize(count);
    const Affine turn = Affine::rotate({0.36, 0.48, 0.8}, 37);
    double sign = 1;
    for (Vec3& axis : axes) {
        axis = sign * glm::normalize(turn(axis));
        sign = -sign;
    }
    return axes;
}

/// A subtree's shadow. Areas are in squares of the ball's radius.
struct Measured {
    std::vector<double> area; ///< by direction
    double mean = 0;
    Vec3 centre{0.0};
    std::vector<double> seen; ///< by edge
};

struct Part {
    NodeId node = 0;
    Affine place;
    double scale = 1;
    std::uint32_t edge = 0; ///< of the subtree's root, that it hangs on
    std::optional<MaterialId> material;
};

/// Unfolds subtrees, largest parts first, and takes their shadows.
class Measurer {
  public:
    Measurer(const CutGraph& cut, std::size_t direction_count)
        : cut_(cut), directions_(directions(direction_count)), coarse_(coarse_grid), fine_(fine_grid) {}

    const std::vector<Vec3>& along() const { return directions_; }
    /// Bodies drawn so far: what all this costs.
    std::uint64_t draws() const { return coarse_.bodies_drawn() + fine_.bodies_drawn(); }

    Measured measure(NodeId node, const Effort& effort) {
        unfold(node, effort.pieces);
        place_bodies();
        Measured result;
        result.seen.assign(cut_.nodes[node].edges.size(), 0);
        area_of_part_.assign(parts_.size(), 0);
        Shadow& shadow = effort.grid == coarse_grid ? coarse_ : fine_;
        const double square = 4.0 / (effort.grid * effort.grid);
        for (const Vec3& direction : directions_) {
            shadow.start(direction, cut_.nodes[node].ball);
            result.area.push_back(square * draw(shadow, result.seen));
            result.mean += result.area.back() / static_cast<double>(directions_.size());
        }
        const double sum = std::accumulate(area_of_part_.begin(), area_of_part_.end(), 0.0);
        result.centre = cut_.nodes[node].ball.centre;
        for (std::size_t i = 0; i < parts_.size() && sum > 0; ++i)
            result.centre += area_of_part_[i] / sum * (bodies_[i].centre - cut_.nodes[node].ball.centre);
        return result;
    }

  private:
    struct Body {
        Primitive primitive = PrimitiveKind::sphere;
        Affine place;
        Vec3 centre{0.0};
    };

    std::size_t bodies_of(const Part& part) const {
        const auto& primitive = cut_.nodes[part.node].primitive;
        return primitive && *primitive != PrimitiveKind::plane ? Shadow::bodies_of(*primitive) : 1;
    }

    bool opens(const Part& part) const { return !cut_.nodes[part.node].edges.empty(); }

    void unfold(NodeId root, std::size_t most) {
        parts_.clear();
        std::size_t bodies = 0;
        using Waiting = std::pair<double, std::int64_t>; // its size, and less its place among the parts
        Walk<Waiting, std::less<>> largest;
        const auto open = [&](const Part& parent, std::size_t reused) {
            const std::vector<CutEdge>& edges = cut_.nodes[parent.node].edges;
            for (std::uint32_t i = 0; i < edges.size(); ++i) {
                const CutEdge& edge = edges[i];
                Part part{edge.child, parent.place * edge.node_from_child, parent.scale * edge.stretch,
                          reused == SIZE_MAX ? i : parent.edge,
                          edge.material ? edge.material : parent.material};
                const std::size_t at = i == 0 && reused != SIZE_MAX ? reused : parts_.size();
                if (at == parts_.size()) parts_.emplace_back();
                parts_[at] = part;
                bodies += bodies_of(part);
                // The earlier of two that are alike first.
                if (opens(part))
                    largest.push(
                        {part.scale * cut_.nodes[part.node].ball.radius, -static_cast<std::int64_t>(at)});
            }
        };
        open({root, {}, 1, 0, {}}, SIZE_MAX);
        // A cycle of single instances would be opened for ever, and never make more parts.
        Waiting next;
        while (largest.visits() < 4 * most && bodies < bodies_a_piece * most && largest.next(next)) {
            const auto at = static_cast<std::size_t>(-next.second);
            const Part part = parts_[at];
            if (parts_.size() + cut_.nodes[part.node].edges.size() <= most + 1) open(part, at);
        }
    }

    void place_bodies() {
        bodies_.clear();
        for (const Part& part : parts_) {
            const CutNode& node = cut_.nodes[part.node];
            const Primitive primitive = node.primitive.value_or(PrimitiveKind::sphere);
            bodies_.push_back(
                {primitive,
                 node.primitive ? part.place * solid_part(node, part) : part.place * node.node_from_proxy,
                 part.place(node.primitive ? node.ball.centre : node.node_from_proxy.translation)});
        }
    }

    /// Where the material's picture is clear a primitive throws no shadow: it is as much smaller.
    Affine solid_part(const CutNode& primitive, const Part& part) const {
        const double coverage = part.material ? cut_.materials[*part.material].coverage : 1;
        if (coverage == 1) return {};
        const Vec3 centre = primitive.ball.centre;
        return Affine::translate(centre) * Affine::scale(Vec3(std::sqrt(coverage))) *
               Affine::translate(-centre);
    }

    /// The area of the union: the sum of the parts' areas, which is exact, times the share of it that the
    /// grid finds not to overlap. Good for what is much thinner than the grid, too.
    double draw(Shadow& shadow, std::vector<double>& seen) {
        order_.clear();
        for (std::size_t i = 0; i < parts_.size(); ++i)
            order_.emplace_back(shadow.depth(bodies_[i].centre), i);
        std::sort(order_.begin(), order_.end());
        double area = 0, samples = 0, uncovered = 0;
        for (const auto& [depth, i] : order_) {
            if (bodies_[i].primitive == PrimitiveKind::plane) continue;
            const Shadow::Cover cover = shadow.draw(bodies_[i].primitive, bodies_[i].place);
            area += cover.area;
            samples += cover.samples;
            uncovered += cover.uncovered;
            area_of_part_[i] += cover.area;
            seen[parts_[i].edge] += cover.area * (cover.samples > 0 ? cover.uncovered / cover.samples : 0.5);
        }
        return samples > 0 ? area * uncovered / samples : area;
    }

    const CutGraph& cut_;
    std::vector<Vec3> directions_;
    Shadow coarse_, fine_;
    std::vector<Part> parts_;
    std::vector<Body> bodies_;
    std::vector<double> area_of_part_;
    std::vector<std::pair<double, std::size_t>> order_;
};

/// Fits the groups of congruent nodes, masters first.
class Fitter {
  public:
    Fitter(CutGraph& cut, const Symmetry& symmetry, WorkMeter* meter)
        : cut_(cut), symmetry_(symmetry), congruence_(find_congruence(cut, symmetry)),
          members_(cut.nodes.size()), seen_(cut.nodes.size()), shadowless_(cut.nodes.size(), false),
          meter_(meter) {
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
        effort_.pieces =
            std::clamp(all_pieces / std::max<std::size_t>(groups, 1), fewest_pieces, most_pieces);
        Measurer measurer(cut_, groups > many_nodes ? 6 : 16);
        measurer_ = &measurer;
        const EllipsoidFit fit(measurer.along());
        fit_ = &fit;
        for (std::size_t c = 0; c < components.members.size(); ++c) {
            roots_ = components.members[c];
            std::erase_if(roots_, [&](NodeId root) { return !fittable(root) || !wanted[root]; });
            if (roots_.empty()) continue;
            if (components.cyclic[c])
                fit_cycle();
            else
                fit_single(roots_.front());
        }
        draws_ = measurer.draws();
        weigh_edges();
        for (NodeId id = 0; id < cut_.nodes.size(); ++id)
            cut_.nodes[id].shadowless = shadowless_[congruence_.root[id]];
    }

    std::uint64_t draws() const { return draws_; }

  private:
    bool fittable(NodeId id) const {
        const CutNode& node = cut_.nodes[id];
        return !node.primitive && !node.edges.empty() && node.edges.size() <= most_edges &&
               node.ball.radius > 0;
    }

    /// Those whose proxies may be drawn, and what these are measured by. A crowd of thousands of small things
    /// keeps the ellipsoid in its box, and none of them is ever drawn by another.
    std::vector<bool> wanted_roots(const Components& components) const {
        std::vector<bool> wanted(cut_.nodes.size(), false);
        for (NodeId id = 0; id < cut_.nodes.size(); ++id)
            if (cut_.nodes[id].cullable || cut_.nodes[id].unending) wanted[congruence_.root[id]] = true;
        wanted[congruence_.root[cut_.root]] = true;
        for (std::size_t c = components.members.size(); c-- > 0;) // users before their masters
            for (const NodeId id : components.members[c])
                if (wanted[id] && fittable(id))
                    for (const CutEdge& edge : cut_.nodes[id].edges)
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
            for (const CutEdge& edge : cut_.nodes[id].edges)
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

    Measured measure(NodeId root, const Effort& effort) {
        const std::uint64_t before = measurer_->draws();
        Measured measured = measurer_->measure(root, effort);
        if (meter_) meter_->add(measurer_->draws() - before);
        return measured;
    }

    void fit_single(NodeId root) {
        if (cut_.nodes[root].unending && !reaches_area(root)) {
            shadowless_[root] = true;
            return;
        }
        take(root, measure(root, effort_), 1);
    }

    /// Whether something it holds, cycles aside, has a shadow.
    bool reaches_area(NodeId root) const {
        for (const CutEdge& edge : cut_.nodes[root].edges) {
            const NodeId master = congruence_.root[edge.child];
            if (std::find(roots_.begin(), roots_.end(), master) == roots_.end() && !shadowless_[master])
                return true;
        }
        return false;
    }

    void fit_cycle() {
        const bool grows = growth_of_area() > 1 + 1e-6;
        if (!grows &&
            std::none_of(roots_.begin(), roots_.end(), [&](NodeId id) { return reaches_area(id); })) {
            for (const NodeId root : roots_)
                shadowless_[root] = true;
            return;
        }
        const std::uint64_t begin = measurer_->draws();
        // Half of what the cycles before have left, and half of that for either step.
        const std::uint64_t allowed = (most_repeated_draws - repeated_draws_) / 4;
        const std::uint64_t round_draws = go_round(allowed);
        if (grows) fit_together(allowed, round_draws);
        repeated_draws_ =
            std::min(repeated_draws_ + measurer_->draws() - begin - round_draws, most_repeated_draws);
    }

    /// Measures the nodes of a cycle by each other's proxies until these stay as they are. Returns what one
    /// round draws.
    std::uint64_t go_round(std::uint64_t allowed) {
        const std::uint64_t begin = measurer_->draws();
        std::uint64_t round_draws = 0;
        std::vector<double> mean(roots_.size(), 0);
        for (int round = 0; round < most_rounds; ++round) {
            double change = 0;
            for (std::size_t i = 0; i < roots_.size(); ++i) {
                const Measured measured = measure(roots_[i], effort_);
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
                    fine_grid};
        fine.pieces = std::clamp(fine.pieces, effort_.pieces, rounds * effort_.pieces);
        double limit = 0;
        std::vector<Measured> measured;
        for (const NodeId root : roots_)
            measured.push_back(measure(root, fine));
        for (const Measured& m : measured)
            limit += m.mean;
        const auto together = [&](double scale) {
            for (std::size_t i = 0; i < roots_.size(); ++i)
                take(roots_[i], measured[i], scale);
            double sum = 0;
            for (const NodeId root : roots_)
                sum += measure(root, {effort_.pieces, fine_grid}).mean;
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
            for (const CutEdge& edge : cut_.nodes[roots_[i]].edges) {
                const auto at = std::find(roots_.begin(), roots_.end(), congruence_.root[edge.child]);
                if (at == roots_.end()) continue;
                const Vec3 s = singular_values(edge.node_from_child.linear);
                factors[i].emplace_back(at - roots_.begin(), (s.x * s.y + s.y * s.z + s.z * s.x) / 3);
            }
        // Of I + M, whose powers converge where those of M may take turns.
        std::vector<double> area(roots_.size(), 1), next(roots_.size());
        double growth = 1;
        for (int step = 0; step < 200; ++step) {
            for (std::size_t i = 0; i < roots_.size(); ++i) {
                next[i] = area[i];
                for (const auto& [child, factor] : factors[i])
                    next[i] += factor * area[child];
            }
            growth = *std::max_element(next.begin(), next.end());
            for (std::size_t i = 0; i < roots_.size(); ++i)
                area[i] = next[i] / growth;
        }
        return growth - 1;
    }

    /// Makes what was measured the proxy of the root and of all that are congruent to it.
    void take(NodeId root, const Measured& measured, double scale) {
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

    /// What was seen of the edges of a root is seen of those that they are paired with.
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
            std::vector<CutEdge>& edges = cut_.nodes[id].edges;
            if (seen_[id].size() != edges.size()) continue;
            for (std::size_t i = 0; i < edges.size(); ++i)
                edges[i].weight = std::max(seen_[id][i], 1e-300);
        }
    }

    CutGraph& cut_;
    const Symmetry& symmetry_;
    Congruence congruence_;
    std::vector<std::vector<NodeId>> members_; ///< by root
    std::vector<Vec3> box_half_;               ///< by node
    std::vector<std::vector<double>> seen_;    ///< by node, then by edge
    std::vector<bool> shadowless_;             ///< by root
    Effort effort_{most_pieces, coarse_grid};
    std::uint64_t draws_ = 0, repeated_draws_ = 0;
    std::vector<NodeId> roots_; ///< of the component under way
    Measurer* measurer_ = nullptr;
    const EllipsoidFit* fit_ = nullptr;
    WorkMeter* meter_ = nullptr;
};

} // namespace

std::uint64_t fit_proxies(CutGraph& cut, const Symmetry& symmetry, WorkMeter* meter) {
    Fitter fitter(cut, symmetry, meter);
    fitter.run();
    set_mean_colours(cut);
    set_finishes(cut);
    return fitter.draws();
}

bool is_flat(const CutNode& node) {
    // The ellipsoid in the box, which is a fiftieth as thick as long at least.
    const Vec3 axes = singular_values(node.node_from_proxy.linear); // it may be turned
    return axes.z <= 0.021 * axes.x;
}

} // namespace graftal
