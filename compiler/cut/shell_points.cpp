#include "compiler/cut/shell_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/cut/cell_table.h"
#include "compiler/cut/choose.h"
#include "compiler/cut/run_cells.h"
#include "compiler/cut/surface_samples.h"

namespace graftal {

namespace {

using Point = std::array<float, 3>;

/// States and their relaxations: more are not worth the points.
constexpr std::size_t most_states = 200'000;
constexpr std::size_t most_relaxations = 2'000'000;
/// Samples of a surface lie closer than cells are wide, so that none is missed.
constexpr double sample_spacing = 0.6;
/// Grids that tell inside from outside are coarser than the points'.
constexpr double first_cells_across = 96, coarse_step = 2.5;
/// Of the points allowed, what is aimed at.
constexpr double share_of_points = 0.45;
/// A set this many cells wide is not worth a look inside.
constexpr double least_cells_across = 48;
/// A limit point is as good as found once the maps on the way to it have shrunk everything by this.
constexpr double seed_accuracy = 1e-7;
constexpr int most_seed_steps = 4000;

/// Of the root's parts that are sampled one by one: so many, down to so many cells across.
constexpr std::size_t most_large_parts = 30'000;
constexpr double least_large_part = 12;

using StateKey = std::pair<NodeId, std::uint32_t>;

/// What a run on a coarse grid leaves to the next.
struct Coarse {
    std::shared_ptr<const InsideGrid> inside;
    std::vector<Point> points; ///< that are not inside
    std::vector<PointPaint> paints;
};
using CoarseStates = std::map<StateKey, Coarse>;

/// The nodes from which some way leads to a primitive.
std::vector<bool> nodes_with_primitives(const CutGraph& cut) {
    std::vector<bool> solid(cut.nodes.size());
    std::vector<std::vector<NodeId>> users(cut.nodes.size());
    std::vector<NodeId> found;
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        for (const CutEdge& edge : cut.nodes[id].edges)
            users[edge.child].push_back(id);
        if (cut.nodes[id].primitive || cut.nodes[id].cell) found.push_back(id);
    }
    while (!found.empty()) {
        const NodeId id = found.back();
        found.pop_back();
        if (solid[id]) continue;
        solid[id] = true;
        found.insert(found.end(), users[id].begin(), users[id].end());
    }
    return solid;
}

/// A node with the levels that it has left, and its points.
struct State {
    StateKey key;
    double stretch = 0; ///< largest product of stretches on a way from the root
    bool tiny = false;  ///< no larger than a cell: a point will do
    bool cut = false;
    double cell = 0;
    Vec3 middle{0.0};
    std::vector<Point> points;
    std::vector<PointPaint> paints;
    CellTable cells;
    std::size_t moved = 0; ///< of its points, those that the users have
    struct Use {
        std::uint32_t parent;
        const CutEdge* edge;
    };
    std::vector<Use> uses;
    std::shared_ptr<const InsideGrid> inside;
};

class PointSystem {
  public:
    PointSystem(const CutGraph& cut, const PointLimits& limits)
        : cut_(cut), limits_(limits), solid_(nodes_with_primitives(cut)),
          painted_(cut.tinted || !cut.materials.empty()) {}

    /// False if a limit is passed.
    bool run(NodeId root, std::uint32_t steps, double cell, const CoarseStates& coarse) {
        states_.clear();
        number_of_.clear();
        kept_ = 0;
        all_work_ += std::exchange(work_, 0);
        cell_ = cell;
        if (!add_states({root, steps})) return false;
        for (State& state : states_) {
            state.cell = cell / state.stretch;
            state.middle = cut_.nodes[state.key.first].ball.centre;
            if (const auto found = coarse.find(state.key); found != coarse.end())
                state.inside = found->second.inside;
        }
        for (std::uint32_t number = 0; number < states_.size(); ++number)
            if (!start(number) || !start_from(number, coarse)) return false;
        return spread();
    }

    /// Samples the primitives of the root's largest parts where they lie: points that went from grid to grid
    /// leave gaps in smooth surfaces.
    bool add_large_parts() {
        struct Part {
            Piece black, white; ///< by what the root inherits
            double size;
            bool operator<(const Part& other) const { return size < other.size; }
        };
        const double cell = root().cell;
        Part whole;
        whole.black.steps = whole.white.steps = root().key.second;
        whole.black.node = whole.white.node = root().key.first;
        whole.black.inherited = Rgb(0.0);
        whole.white.inherited = Rgb(1.0);
        whole.size = std::numeric_limits<double>::infinity();
        std::priority_queue<Part> queue;
        queue.push(whole);
        for (std::size_t parts = 0; !queue.empty() && parts < most_large_parts; ++parts) {
            const Part part = queue.top();
            queue.pop();
            const CutNode& node = cut_.nodes[part.black.node];
            const bool cut = node.unending && part.black.steps == 0;
            bool fits = true;
            for_each_edge(node, cut, [&](const CutEdge& edge) {
                Part child{descend(cut_, part.black, edge, cut), descend(cut_, part.white, edge, cut), 0};
                if (const auto primitive = cut_.nodes[edge.child].primitive) {
                    fits = fits && sample(0, *primitive, child.black.world_from_node,
                                          paint_of(child.black, child.white));
                    return;
                }
                child.size = 2 * child.black.scale * cut_.nodes[edge.child].ball.radius;
                if (child.size > least_large_part * cell && queue.size() < most_large_parts)
                    queue.push(std::move(child));
            });
            if (!fits) return false;
        }
        return true;
    }

    State& root() { return states_.front(); }
    std::size_t kept() const { return kept_; }
    std::uint64_t work() const { return work_; } ///< of the last run
    std::uint64_t all_work() const { return all_work_ + work_; }

    /// What is inside of the larger states, and their points outside of it. The points of this run are gone
    /// then.
    CoarseStates take_coarse() {
        CoarseStates found;
        for (State& state : states_) {
            // Where a finer look takes too much room, the last one will do.
            auto inside = find_inside(state.points, state.cell, state.inside.get(), work_);
            if (!inside) inside = state.inside;
            if (!inside) continue;
            Coarse& coarse = found[state.key];
            for (std::size_t i = 0; i < state.points.size(); ++i) {
                if (inside->has(state.points[i])) continue;
                coarse.points.push_back(state.points[i]);
                if (painted_) coarse.paints.push_back(state.paints[i]);
            }
            coarse.inside = std::move(inside);
        }
        return found;
    }

  private:
    const CutNode& node_of(const State& state) const { return cut_.nodes[state.key.first]; }
    double stretch_of(const CutEdge& edge) const {
        return cut_.contractive ? edge.stretch : edge.volume_stretch;
    }

    std::optional<std::uint32_t> state_number(StateKey key) {
        if (!cut_.nodes[key.first].unending) key.second = unlimited_steps;
        const auto [place, added] = number_of_.emplace(key, static_cast<std::uint32_t>(states_.size()));
        if (added) {
            if (states_.size() >= most_states) return std::nullopt;
            states_.emplace_back();
            states_.back().key = key;
        }
        return place->second;
    }

    /// Largest first, as shortest ways are found (E. Dijkstra 1959); what is met again by a longer way is
    /// done again.
    bool add_states(StateKey root) {
        std::priority_queue<std::pair<double, std::uint32_t>> queue;
        const auto first = state_number(root);
        states_[*first].stretch = 1;
        queue.emplace(1.0, *first);
        for (std::size_t relaxations = 0; !queue.empty();) {
            const auto [stretch, number] = queue.top();
            queue.pop();
            if (stretch < states_[number].stretch) continue;
            const CutNode& node = node_of(states_[number]);
            if (node.unbounded) return false;
            const std::uint32_t steps = states_[number].key.second;
            const double diameter = 2 * node.ball.radius * stretch;
            states_[number].tiny = diameter <= cell_;
            states_[number].cut = node.unending && steps == 0;
            if (states_[number].tiny) continue;
            for (const CutEdge& edge : followed_edges(node, states_[number].cut)) {
                if (cut_.nodes[edge.child].primitive) continue;
                const auto child = state_number({edge.child, steps_after(steps, edge)});
                if (!child || ++relaxations > most_relaxations) return false;
                const double child_stretch = stretch * stretch_of(edge);
                if (!(child_stretch > states_[*child].stretch * (1 + 1e-12))) continue;
                states_[*child].stretch = child_stretch;
                queue.emplace(child_stretch, *child);
            }
        }
        // What no way reaches with a size has none.
        for (State& state : states_)
            if (!(state.stretch > 0)) return false;
        return true;
    }

    /// The points that a state has of its own, and what it hands on to whom.
    bool start(std::uint32_t number) {
        State& state = states_[number];
        const CutNode& node = node_of(state);
        if (state.tiny) return add(number, {0, 0, 0}, ended(node));
        if (edge_count(node, state.cut) == 0)
            return sample(number, PrimitiveKind::sphere, node.node_from_proxy, mean_of(node));
        bool fits = true;
        for_each_edge(node, state.cut, [&](const CutEdge& edge) {
            if (const auto primitive = cut_.nodes[edge.child].primitive)
                fits = fits && sample(number, *primitive, edge.node_from_child,
                                      paint_through(PointPaint(), edge, state));
        });
        for (const CutEdge& edge : followed_edges(node, state.cut)) {
            if (cut_.nodes[edge.child].primitive) continue;
            states_[*state_number({edge.child, steps_after(state.key.second, edge)})].uses.push_back(
                {number, &edge});
        }
        if (!fits) return false;
        if (!solid_[state.key.first] && state.key.second == unlimited_steps) return add_seed(number);
        return true;
    }

    PointPaint paint_of(const Piece& black, const Piece& white) const {
        PointPaint paint;
        if (!painted_) return paint;
        const Rgb fixed = black.tint.over(black.inherited), whole = white.tint.over(white.inherited);
        for (int k = 0; k < 3; ++k)
            paint.fixed[static_cast<std::size_t>(k)] = static_cast<float>(fixed[k]);
        paint.open = static_cast<float>(whole.x - fixed.x);
        if (black.material) paint.material = static_cast<std::int32_t>(*black.material);
        return paint;
    }

    /// The hull of a set is made of the hulls of its parts: where what is inside is left out, points have to
    /// begin outside.
    bool start_from(std::uint32_t number, const CoarseStates& coarse) {
        const auto found = coarse.find(states_[number].key);
        if (found == coarse.end()) return true;
        const auto& [inside, points, paints] = found->second;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (!add(number, points[i], painted_ ? paints[i] : PointPaint())) return false;
        return true;
    }

    static PointPaint mean_of(const CutNode& node) {
        PointPaint paint;
        for (int k = 0; k < 3; ++k)
            paint.fixed[static_cast<std::size_t>(k)] = static_cast<float>(node.mean.fixed[k]);
        paint.open = static_cast<float>(node.mean.open);
        return paint;
    }

    /// What is drawn where parts end: the terminal, if there is one, by its own material.
    PointPaint ended(const CutNode& node) const {
        if (!node.terminal || node.stop_edges.empty()) return mean_of(node);
        const CutEdge& edge = node.stop_edges.front();
        return mean_of(cut_.nodes[edge.child]).through(edge, &node, cut_.materials);
    }

    PointPaint paint_through(const PointPaint& paint, const CutEdge& edge, const State& parent) const {
        if (!painted_) return paint;
        const CutNode& node = node_of(parent);
        return paint.through(edge, parent.cut && node.terminal ? &node : nullptr, cut_.materials);
    }

    bool sample(std::uint32_t number, PrimitiveKind kind, const Affine& node_from_primitive,
                const PointPaint& paint) {
        const State& state = states_[number];
        const Affine place = Affine::translate(-state.middle) * node_from_primitive;
        return sample_surface(kind, place, sample_spacing * state.cell, [&](Vec3 p) {
            return ++work_ <= limits_.work && add(number, point_of(p), paint);
        });
    }

    static Point point_of(Vec3 p) {
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }

    /// A point of the limit: where the first way round leads, if it is gone for ever.
    bool add_seed(std::uint32_t number) {
        const State& state = states_[number];
        const double radius = node_of(state).ball.radius;
        Affine node_from_here;
        std::vector<const CutEdge*> way;
        NodeId here = state.key.first;
        for (int i = 0; i < most_seed_steps; ++i) {
            if (norm(node_from_here.linear) * cut_.nodes[here].ball.radius <= seed_accuracy * radius) break;
            const CutEdge* next = nullptr;
            for (const CutEdge& edge : cut_.nodes[here].edges)
                if (!next && cut_.nodes[edge.child].unending) next = &edge;
            if (!next) break;
            ++work_;
            way.push_back(next);
            node_from_here = node_from_here * next->node_from_child;
            here = next->child;
        }
        PointPaint paint = ended(cut_.nodes[here]);
        if (painted_)
            for (std::size_t i = way.size(); i-- > 0;)
                paint = paint.through(*way[i], nullptr, cut_.materials);
        return add(number, point_of(node_from_here(cut_.nodes[here].ball.centre) - state.middle), paint);
    }

    static std::uint64_t packed_cell(const Point& point, double cell) {
        const auto at = [&](std::size_t k) {
            return static_cast<std::int64_t>(std::floor(static_cast<double>(point[k]) / cell));
        };
        return CellKey{at(0), at(1), at(2)}.packed();
    }

    /// False beyond the limits; a point whose cell is taken, or that nobody can see, is left out.
    bool add(std::uint32_t number, const Point& point, const PointPaint& paint) {
        State& state = states_[number];
        if (state.inside && state.inside->has(point)) return true;
        for (const float place : point)
            if (!(std::abs(static_cast<double>(place)) < static_cast<double>(CellKey::most) * state.cell))
                return false;
        const auto next = static_cast<std::uint32_t>(state.points.size());
        const auto cell_of = [&](std::uint32_t i) { return packed_cell(state.points[i], state.cell); };
        if (state.cells.find_or_add(packed_cell(point, state.cell), next, cell_of) != next) return true;
        state.points.push_back(point);
        if (painted_) state.paints.push_back(paint);
        return ++kept_ <= limits_.points;
    }

    /// Moves every point through every use of its state, until no new ones come.
    bool spread() {
        for (bool more = true; more;) {
            more = false;
            for (std::size_t number = states_.size(); number-- > 0;) {
                if (states_[number].moved == states_[number].points.size()) continue;
                more = true;
                const std::size_t first = states_[number].moved, last = states_[number].points.size();
                states_[number].moved = last;
                for (const State::Use& use : states_[number].uses)
                    if (!move(states_[number], first, last, use)) return false;
            }
        }
        return true;
    }

    bool move(const State& child, std::size_t first, std::size_t last, const State::Use& use) {
        const State& parent = states_[use.parent];
        const Mat3& linear = use.edge->node_from_child.linear;
        const Vec3 offset = use.edge->node_from_child(child.middle) - parent.middle;
        work_ += last - first;
        if (work_ > limits_.work) return false;
        for (std::size_t i = first; i < last; ++i) {
            const Point p = child.points[i]; // a copy: the child may be the parent
            const Point moved = point_of(linear * Vec3(p[0], p[1], p[2]) + offset);
            const PointPaint paint =
                painted_ ? paint_through(child.paints[i], *use.edge, parent) : PointPaint();
            if (!add(use.parent, moved, paint)) return false;
        }
        return true;
    }

    const CutGraph& cut_;
    PointLimits limits_;
    std::vector<bool> solid_; ///< by node: some primitive is drawn of it
    bool painted_;
    double cell_ = 0;
    std::vector<State> states_;
    std::map<StateKey, std::uint32_t> number_of_;
    std::size_t kept_ = 0;
    std::uint64_t work_ = 0, all_work_ = 0;
};

/// Predicts how many points a finer grid takes.
class Growth {
  public:
    /// `flat`: in a plane.
    void add(double cell, double points, bool flat) {
        // What is inside of a set in space is left out sooner or later, so that no growth that was seen can
        // be relied on.
        power_ = flat ? 2 : 2.6;
        last_cell_ = cell;
        last_points_ = std::max(1.0, points);
    }
    /// The least cell with so many points.
    double finest_for(double points) const {
        return last_cell_ * std::pow(last_points_ / points, 1 / power_);
    }

  private:
    double last_cell_ = 0, last_points_ = 0;
    double power_ = 3;
};

/// True if the points fill no space.
bool in_one_plane(const std::vector<Point>& points, double radius) {
    return std::ranges::all_of(points, [&](const Point& p) {
        return std::abs(static_cast<double>(p[2]) - static_cast<double>(points.front()[2])) <= 1e-5 * radius;
    });
}

} // namespace

PointPaint PointPaint::through(const CutEdge& edge, const CutNode* parent,
                               const std::vector<Material>& materials) const {
    PointPaint seen = *this;
    const auto inherits = [&](Rgb below, double through) {
        for (int k = 0; k < 3; ++k)
            seen.fixed[static_cast<std::size_t>(k)] +=
                static_cast<float>(static_cast<double>(seen.open) * below[k]);
        seen.open *= static_cast<float>(through);
    };
    if (edge.material && seen.material < 0) {
        inherits(materials[*edge.material].rgb, 0);
        seen.material = static_cast<std::int32_t>(*edge.material);
    } else if (parent) {
        inherits(parent->mean.fixed, parent->mean.open);
    }
    const auto through = static_cast<float>(1 - edge.tint.alpha);
    for (int k = 0; k < 3; ++k) {
        float& part = seen.fixed[static_cast<std::size_t>(k)];
        part = static_cast<float>(edge.tint.premultiplied[k]) + through * part;
    }
    seen.open *= through;
    return seen;
}

std::optional<PointSet> point_set(const CutGraph& cut, NodeId node, std::uint32_t steps,
                                  double detail_per_unit, const PointLimits& limits) {
    const CutNode& root = cut.nodes[node];
    if (root.unbounded || root.primitive || !(detail_per_unit > 0) || !std::isfinite(detail_per_unit))
        return std::nullopt;
    const double asked = 1 / detail_per_unit, diameter = 2 * root.ball.radius;
    PointSystem system(cut, limits);
    CoarseStates coarse;
    Growth growth;
    double cell = asked;
    bool limited = false;
    if (diameter >= least_cells_across * asked) {
        // Coarse grids first: they say how many points a finer one will have, and what nobody can see.
        for (cell = std::max(asked, diameter / first_cells_across); cell > asked;) {
            if (!system.run(node, steps, cell, coarse)) return std::nullopt;
            const bool flat = in_one_plane(system.root().points, root.ball.radius);
            growth.add(cell, static_cast<double>(system.kept()), flat);
            if (!flat) coarse = system.take_coarse();
            const double moves_a_point = static_cast<double>(system.work()) /
                                         static_cast<double>(std::max<std::size_t>(1, system.kept()));
            const double points = std::min(static_cast<double>(limits.points),
                                           static_cast<double>(limits.work) / moves_a_point);
            const double finest = growth.finest_for(share_of_points * points);
            limited = finest >= cell;
            if (limited) break;
            cell = std::max({asked, finest, cell / coarse_step});
        }
    }
    const double serves_from = cell;
    // What is predicted is not certain.
    constexpr double coarser = 1.5;
    constexpr int most_tries = 12;
    for (int tries = 0; !system.run(node, steps, cell, coarse) || !system.add_large_parts(); ++tries) {
        if (tries == most_tries || system.all_work() > 2 * limits.work) return std::nullopt;
        cell *= coarser;
    }
    State& state = system.root();
    PointSet set;
    set.cell = state.cell;
    set.finest_asked = limited ? 0 : asked;
    set.coarsest_asked = serves_from;
    set.middle = state.middle;
    set.flat = in_one_plane(state.points, root.ball.radius);
    set.points = std::move(state.points);
    set.paints = std::move(state.paints);
    set.inside = state.inside;
    set.work = system.all_work();
    return set;
}

} // namespace graftal
