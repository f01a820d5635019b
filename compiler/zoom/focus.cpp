#include "compiler/zoom/focus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/analysis/run_bounds.h"
#include "compiler/primitives/primitive.h"

namespace graftal {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

const Instance& instance_of(const Graph& graph, const GraphStep& step) {
    return graph.objects[step.object].instances[step.instance];
}

ObjectId object_before(const Graph& graph, const GraphPath& path, std::size_t i) {
    if (i < path.steps.size() || path.endless()) return path.at(i).object;
    return path.steps.empty() ? graph.root : instance_of(graph, path.steps.back()).master;
}

/// The point that the maps of the cycle, one after the other, leave where it is.
Vec3 fixed_point(const Graph& graph, const std::vector<GraphStep>& cycle) {
    Affine round;
    for (const GraphStep& step : cycle)
        round = round * instance_of(graph, step).parent_from_child;
    return glm::inverse(Mat3(1.0) - round.linear) * round.translation;
}

/// Fills in the points before the last one, each the image of the next: contracting, so without growing
/// errors.
void pull_up(const Graph& graph, Focus& focus, Vec3 last, std::size_t count) {
    focus.points.resize(count + 1);
    focus.points[count] = last;
    for (std::size_t i = count; i-- > 0;)
        focus.points[i] = instance_of(graph, focus.path.at(i)).parent_from_child(focus.points[i + 1]);
}

/// A direction of the root's frame in that of the object at the path's end: of two points there, the one that
/// is farther along this is so along the other in the root.
Vec3 pulled_down(const Graph& graph, const GraphPath& path, Vec3 direction) {
    for (const GraphStep& step : path.steps) {
        const Vec3 pulled = glm::transpose(instance_of(graph, step).parent_from_child.linear) * direction;
        direction = pulled / glm::length(pulled);
    }
    return direction;
}

/// True, by object, if a path along maps that can be inverted leads on from it for ever.
std::vector<bool> endless_objects(const Graph& graph) {
    const std::size_t count = graph.objects.size();
    std::vector<std::vector<ObjectId>> users(count);
    std::vector<std::size_t> ways(count, 0); // into objects that are not known to end
    for (ObjectId id = 0; id < count; ++id)
        for (const Instance& instance : graph.objects[id].instances)
            if (!graph.objects[id].is_combined() && !is_singular(instance.parent_from_child)) {
                users[instance.master].push_back(id);
                ++ways[id];
            }
    std::vector<ObjectId> ending;
    for (ObjectId id = 0; id < count; ++id)
        if (ways[id] == 0) ending.push_back(id);
    while (!ending.empty()) {
        const ObjectId id = ending.back();
        ending.pop_back();
        for (const ObjectId user : users[id])
            if (--ways[user] == 0) ending.push_back(user);
    }
    std::vector<bool> endless;
    for (const std::size_t left : ways)
        endless.push_back(left > 0);
    return endless;
}

/// Follows a point down, part by part.
class PointWalk {
  public:
    /// `nearest`: where no part holds the point, the nearest part.
    PointWalk(const Graph& graph, const std::vector<ObjectBounds>& bounds, Vec3 point, bool nearest)
        : graph_(graph), bounds_(bounds), endless_(nearest ? endless_objects(graph) : std::vector<bool>()),
          nearest_(nearest), object_(graph.root), point_(point), error_(epsilon * glm::length(point)) {
        note();
    }

    /// One step; false at the end of the path.
    bool step() {
        if (graph_.objects[object_].is_combined()) return false; // its parts are not drawn by themselves
        std::optional<std::uint32_t> best;
        double best_ratio = nearest_ ? std::numeric_limits<double>::infinity() : 1 + 1e-6;
        const std::vector<Instance>& instances = graph_.objects[object_].instances;
        for (std::uint32_t i = 0; i < instances.size(); ++i) {
            const Ball& ball = bounds_[instances[i].master].ball;
            const bool point_like =
                !(ball.radius > 0) || (graph_.objects[instances[i].master].primitive && !ends_in_primitive());
            const bool dead_end = nearest_ && endless_[object_] && !endless_[instances[i].master];
            if (point_like || dead_end || is_singular(instances[i].parent_from_child)) continue;
            const Vec3 pulled = inverse(instances[i].parent_from_child)(point_);
            const double enlarged = norm(inverse(instances[i].parent_from_child).linear) * error_;
            const double ratio = std::max(0.0, glm::distance(pulled, ball.centre) - enlarged) / ball.radius;
            if (ratio < best_ratio) best = i, best_ratio = ratio;
        }
        if (!best) return false;
        take(*best);
        return !known_to_recur_ && !graph_.objects[object_].primitive;
    }

    /// The point is no better known than the part is large.
    bool digits_spent() const { return error_ > 1e-5 * bounds_[object_].ball.radius; }
    double log2_size() const { return log2_size_; }
    ObjectId object() const { return object_; }
    bool recurs() const { return known_to_recur_; }
    double error() const { return error_; }
    Vec3 point() const { return point_; }
    GraphPath path() && { return std::move(path_); }

  private:
    struct Visit {
        std::size_t step;
        Vec3 point;
        double error;
    };
    static constexpr std::size_t most_visits = 64;

    /// True if the way ends: not in an endless model, nor where a point is asked for.
    bool ends_in_primitive() const { return nearest_ && !endless_[object_]; }

    void take(std::uint32_t instance) {
        const Instance& step = graph_.objects[object_].instances[instance];
        const Affine child_from_parent = inverse(step.parent_from_child);
        path_.steps.push_back({object_, instance});
        object_ = step.master;
        point_ = child_from_parent(point_);
        error_ = norm(child_from_parent.linear) * error_ + 4 * epsilon * glm::length(point_);
        log2_size_ += std::log2(std::cbrt(std::abs(glm::determinant(step.parent_from_child.linear))));
        const Ball& ball = bounds_[object_].ball;
        const double distance = glm::distance(point_, ball.centre);
        // Only the direction of a point far outside matters.
        if (nearest_ && distance > 2 * ball.radius)
            point_ = ball.centre + (2 * ball.radius / distance) * (point_ - ball.centre);
        note();
    }

    void note() {
        const double radius = std::max(bounds_[object_].ball.radius, 0.0);
        for (const Visit& visit : visits_[object_]) {
            const double allowed =
                nearest_ ? 1e-9 * radius : std::min(1e-6 * radius, 4 * (visit.error + error_));
            if (glm::distance(visit.point, point_) > allowed) continue;
            const auto begin = path_.steps.begin() + static_cast<std::ptrdiff_t>(visit.step);
            path_.cycle.assign(begin, path_.steps.end());
            path_.steps.erase(begin, path_.steps.end());
            known_to_recur_ = true;
            return;
        }
        if (visits_[object_].size() < most_visits)
            visits_[object_].push_back({path_.steps.size(), point_, error_});
    }

    const Graph& graph_;
    const std::vector<ObjectBounds>& bounds_;
    std::vector<bool> endless_;
    bool nearest_;
    ObjectId object_;
    Vec3 point_;
    double error_;
    double log2_size_ = 0;
    bool known_to_recur_ = false;
    GraphPath path_;
    std::map<ObjectId, std::vector<Visit>> visits_;
};

} // namespace

Focus focus_of_path(const Graph& graph, const std::vector<ObjectBounds>& bounds, GraphPath path) {
    Focus focus;
    focus.path = std::move(path);
    const std::size_t straight = focus.path.steps.size();
    if (focus.path.endless()) {
        pull_up(graph, focus, fixed_point(graph, focus.path.cycle), straight + focus.path.cycle.size());
        return focus;
    }
    const ObjectId last = object_before(graph, focus.path, straight);
    pull_up(graph, focus, bounds[last].ball.empty() ? Vec3(0.0) : bounds[last].ball.centre, straight);
    return focus;
}

Focus focus_at_point(const Graph& graph, const std::vector<ObjectBounds>& bounds, Vec3 point) {
    PointWalk walk(graph, bounds, point, false);
    while (!walk.digits_spent() && walk.step()) {
    }
    if (walk.recurs()) return focus_of_path(graph, bounds, std::move(walk).path());
    Focus focus;
    const Vec3 last = walk.point();
    focus.error = walk.error();
    focus.path = std::move(walk).path();
    pull_up(graph, focus, last, focus.path.steps.size());
    return focus;
}

Focus focus_near_point(const Graph& graph, const std::vector<ObjectBounds>& bounds, Vec3 point,
                       const Magnification& zoom, Vec3 to_eye) {
    constexpr double margin = 30; // binary orders beyond what the zoom shows
    constexpr std::size_t most_steps = 10'000'000;
    PointWalk walk(graph, bounds, point, true);
    for (std::size_t i = 0; i < most_steps && walk.log2_size() + zoom.log2() > -margin; ++i)
        if (!walk.step()) break;
    const ObjectId object = walk.object();
    const Object& last = graph.objects[object];
    const Vec3 nearest = walk.point();
    GraphPath path = std::move(walk).path();
    if (!(last.primitive || last.packed) || path.endless())
        return focus_of_path(graph, bounds, std::move(path));
    Focus focus;
    focus.path = std::move(path);
    const Vec3 direction = pulled_down(graph, focus.path, to_eye);
    const Vec3 seen = last.packed ? bounds[object].run->surface_near(nearest, direction)
                                  : traits_of(*last.primitive).support_point(*last.primitive, direction);
    pull_up(graph, focus, seen, focus.path.steps.size());
    return focus;
}

} // namespace graftal
