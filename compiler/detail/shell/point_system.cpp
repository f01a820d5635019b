#include "compiler/detail/shell/point_system.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/graph/walk.h"
#include "compiler/primitives/surface_samples.h"

namespace graftal {

namespace {

using Point = std::array<float, 3>;

/// States and their relaxations: more are not worth the points.
constexpr std::size_t most_states = 200'000;
constexpr std::size_t most_relaxations = 2'000'000;
/// Points that are moved in the time that it takes to follow an edge from one state to another.
constexpr std::uint64_t moves_a_relaxation = 4;
/// In the time that a state takes to be made and done with.
constexpr std::uint64_t moves_a_state = 30;
/// Samples of a surface lie closer than cells are wide, so that none is missed.
constexpr double sample_spacing = 0.6;
/// A limit point is as good as found once the maps on the way to it have shrunk everything by this.
constexpr double seed_accuracy = 1e-7;
constexpr int most_seed_steps = 4000;

/// Most of the root's parts that are sampled one by one, and the least size of one, in cells.
constexpr std::size_t most_large_parts = 30'000;
constexpr double least_large_part = 12;

/// Points and states after which it asks whether somebody still wants them.
constexpr std::uint64_t points_a_look = 1 << 14;

} // namespace

PointSystem::PointSystem(const DetailGraph& cut, std::size_t most_points, const CancelFlag& cancel)
    : cut_(cut), most_points_(most_points),
      painted_(cut.tinted || !cut.materials.empty()), control_{cancel, {}},
      meter_(control_, "shell", points_a_look) {}

bool PointSystem::run(NodeId root, std::uint32_t steps, double cell, const CoarseStates& coarse,
                      std::uint64_t most_work) {
    most_work_ = most_work;
    states_.clear();
    number_of_.clear();
    kept_ = 0;
    all_work_ += std::exchange(work_, 0);
    cell_ = cell;
    if (!add_states({root, steps})) return false;
    for (State& state : states_) {
        state.cell = cell / state.stretch;
        state.middle = cut_.nodes[state.key.node].ball.centre;
        if (const auto found = coarse.find(state.key); found != coarse.end())
            state.inside = found->second.inside;
    }
    for (std::uint32_t number = 0; number < states_.size(); ++number)
        if (!start(number) || !start_from(number, coarse)) return false;
    return spread();
}

bool PointSystem::add_large_parts() {
    struct Part {
        Piece black, white; ///< by what the root inherits
        double size;
        bool operator<(const Part& other) const { return size < other.size; }
    };
    const double cell = root().cell;
    Part whole;
    whole.black.steps = whole.white.steps = root().key.steps;
    whole.black.node = whole.white.node = root().key.node;
    whole.black.inherited = Rgb(0.0);
    whole.white.inherited = Rgb(1.0);
    whole.size = std::numeric_limits<double>::infinity();
    Walk<Part, std::less<>> walk({.most_visits = most_large_parts});
    walk.push(whole);
    for (Part part; walk.next(part);) {
        const DetailNode& node = cut_.nodes[part.black.node];
        const bool cut = node.unending && part.black.steps == 0;
        bool fits = true;
        for_each_edge(node, cut, [&](const DetailEdge& edge) {
            Part child{descend(cut_, part.black, edge, cut), descend(cut_, part.white, edge, cut), 0};
            if (const auto primitive = cut_.nodes[edge.child].primitive) {
                fits = fits &&
                       sample(0, *primitive, child.black.world_from_node, paint_of(child.black, child.white));
                return;
            }
            child.size = 2 * child.black.scale * cut_.nodes[edge.child].ball.radius;
            if (child.size > least_large_part * cell && walk.waiting() < most_large_parts)
                walk.push(std::move(child));
        });
        if (!fits) return false;
    }
    return true;
}

PointSystem::CoarseStates PointSystem::take_coarse() {
    CoarseStates found;
    for (State& state : states_) {
        // Where a finer look takes too much room or work, the last one is taken.
        std::shared_ptr<const InsideGrid> inside =
            find_inside(state.points, state.cell, state.inside.get(), work_, most_work_, control_.cancel);
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

double PointSystem::stretch_of(const DetailEdge& edge) const {
    return cut_.contractive ? edge.stretch : edge.volume_stretch;
}

std::optional<std::uint32_t> PointSystem::state_number(PieceKind key) {
    meter_.add();
    key = without_idle_levels(cut_, key);
    const auto next = static_cast<std::uint32_t>(states_.size());
    const std::uint32_t number = number_of_.find_or_add(
        PieceKindHash()(key), next, [&](std::uint32_t other) { return states_[other].key == key; });
    if (number == next) {
        if (states_.size() >= most_states) return std::nullopt;
        work_ += moves_a_state;
        states_.emplace_back();
        states_.back().key = key;
    }
    return number;
}

bool PointSystem::add_states(const PieceKind& root) {
    using Reached = std::pair<double, std::uint32_t>; // a stretch, and a state
    Walk<Reached, std::less<>> walk;
    const auto first = state_number(root);
    states_[*first].stretch = 1;
    walk.push({1.0, *first});
    std::size_t relaxations = 0;
    for (Reached reached; walk.next(reached);) {
        const auto [stretch, number] = reached;
        if (stretch < states_[number].stretch) continue;
        const DetailNode& node = node_of(states_[number]);
        if (node.unbounded) return false;
        const std::uint32_t steps = states_[number].key.steps;
        const double diameter = 2 * node.ball.radius * stretch;
        states_[number].tiny = diameter <= cell_;
        states_[number].cut = node.unending && steps == 0;
        if (states_[number].tiny) continue;
        for (const DetailEdge& edge : followed_edges(node, states_[number].cut)) {
            if (cut_.nodes[edge.child].primitive) continue;
            const auto child = state_number({edge.child, steps_below(steps, edge)});
            work_ += moves_a_relaxation;
            if (!child || ++relaxations > most_relaxations || work_ > most_work_) return false;
            const double child_stretch = stretch * stretch_of(edge);
            if (!(child_stretch > states_[*child].stretch * (1 + 1e-12))) continue;
            states_[*child].stretch = child_stretch;
            walk.push({child_stretch, *child});
        }
    }
    // A node that no way reaches with a size has none.
    for (State& state : states_)
        if (!(state.stretch > 0)) return false;
    return true;
}

bool PointSystem::start(std::uint32_t number) {
    State& state = states_[number];
    const DetailNode& node = node_of(state);
    if (state.tiny) return add(number, {0, 0, 0}, ended(node));
    if (edge_count(node, state.cut) == 0)
        return sample(number, PrimitiveKind::sphere, node.node_from_proxy, mean_of(node));
    bool fits = true;
    for_each_edge(node, state.cut, [&](const DetailEdge& edge) {
        if (const auto primitive = cut_.nodes[edge.child].primitive)
            fits = fits && sample(number, *primitive, edge.node_from_child,
                                  painted_ ? PointPaint().above(step_from(state, edge)) : PointPaint());
    });
    for (const DetailEdge& edge : followed_edges(node, state.cut)) {
        if (cut_.nodes[edge.child].primitive) continue;
        work_ += moves_a_relaxation;
        states_[*state_number({edge.child, steps_below(state.key.steps, edge)})].uses.push_back(
            {number, &edge});
    }
    if (!fits || work_ > most_work_) return false;
    if (!node.solid && state.key.steps == unlimited_steps) return add_seed(number);
    return true;
}

PointPaint PointSystem::paint_of(const Piece& black, const Piece& white) const {
    if (!painted_) return {};
    const Rgb fixed = black.tint.over(black.inherited), whole = white.tint.over(white.inherited);
    PointPaint paint{Paint(MeanColour{fixed, whole.x - fixed.x})};
    if (black.material) paint.material = static_cast<std::int32_t>(*black.material);
    return paint;
}

bool PointSystem::start_from(std::uint32_t number, const CoarseStates& coarse) {
    const auto found = coarse.find(states_[number].key);
    if (found == coarse.end()) return true;
    const auto& [inside, points, paints] = found->second;
    work_ += points.size();
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!add(number, points[i], painted_ ? paints[i] : PointPaint())) return false;
    return true;
}

PointPaint PointSystem::mean_of(const DetailNode& node) {
    return {Paint(node.mean)};
}

PointPaint PointSystem::ended(const DetailNode& node) const {
    if (!node.terminal || node.stop_edges.empty()) return mean_of(node);
    const DetailEdge& edge = node.stop_edges.front();
    return mean_of(cut_.nodes[edge.child]).above(look_step(cut_, node, true, edge));
}

LookStep PointSystem::step_from(const State& parent, const DetailEdge& edge) const {
    return look_step(cut_, node_of(parent), parent.cut, edge);
}

bool PointSystem::sample(std::uint32_t number, const Primitive& primitive, const Affine& node_from_primitive,
                         const PointPaint& paint) {
    const State& state = states_[number];
    const Affine place = Affine::translate(-state.middle) * node_from_primitive;
    return sample_surface(primitive, place, sample_spacing * state.cell,
                          [&](Vec3 p) { return ++work_ <= most_work_ && add(number, point_of(p), paint); });
}

Point PointSystem::point_of(Vec3 p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

bool PointSystem::add_seed(std::uint32_t number) {
    const State& state = states_[number];
    const double radius = node_of(state).ball.radius;
    Affine node_from_here;
    std::vector<const DetailEdge*> way;
    NodeId here = state.key.node;
    for (int i = 0; i < most_seed_steps; ++i) {
        if (norm(node_from_here.linear) * cut_.nodes[here].ball.radius <= seed_accuracy * radius) break;
        const DetailEdge* next = nullptr;
        for (const DetailEdge& edge : cut_.nodes[here].edges)
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
            paint = paint.above(look_step(*way[i], nullptr, cut_.materials));
    return add(number, point_of(node_from_here(cut_.nodes[here].ball.centre) - state.middle), paint);
}

std::uint64_t PointSystem::packed_cell(const Point& point, double cell) {
    const auto at = [&](std::size_t k) {
        return static_cast<std::int64_t>(std::floor(static_cast<double>(point[k]) / cell));
    };
    return CellKey{at(0), at(1), at(2)}.packed();
}

bool PointSystem::add(std::uint32_t number, const Point& point, const PointPaint& paint) {
    meter_.add();
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
    return ++kept_ <= most_points_;
}

bool PointSystem::spread() {
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

bool PointSystem::move(const State& child, std::size_t first, std::size_t last, const State::Use& use) {
    const State& parent = states_[use.parent];
    const Mat3& linear = use.edge->node_from_child.linear;
    const Vec3 offset = use.edge->node_from_child(child.middle) - parent.middle;
    const LookStep step = step_from(parent, *use.edge);
    work_ += last - first;
    if (work_ > most_work_) return false;
    for (std::size_t i = first; i < last; ++i) {
        const Point p = child.points[i]; // a copy: the child may be the parent
        const Point moved = point_of(linear * Vec3(p[0], p[1], p[2]) + offset);
        const PointPaint paint = painted_ ? child.paints[i].above(step) : PointPaint();
        if (!add(use.parent, moved, paint)) return false;
    }
    return true;
}

} // namespace graftal
