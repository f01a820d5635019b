#include "runtime/studio/part_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/graph/path.h"
#include "compiler/primitives/intersect.h"

namespace graftal {

namespace {

constexpr std::uint32_t no_place = UINT32_MAX;

/// Where a ray goes into a box; nothing where it misses it.
std::optional<double> entry(const Box& box, const Ray& ray) {
    double least = 0, most = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const double slack = 1e-9 * (std::abs(box.min[i]) + std::abs(box.max[i]));
        double in = box.min[i] - slack - ray.origin[i], out = box.max[i] + slack - ray.origin[i];
        if (ray.direction[i] == 0) {
            if (in > 0 || out < 0) return std::nullopt;
            continue;
        }
        in /= ray.direction[i];
        out /= ray.direction[i];
        if (in > out) std::swap(in, out);
        least = std::max(least, in);
        most = std::min(most, out);
    }
    return least <= most ? std::optional(least) : std::nullopt;
}

std::optional<double> entry(const Ball& ball, const Affine& world_from_object, const Ray& ray) {
    const double radius = norm(world_from_object.linear) * std::max(ball.radius, 0.0);
    const Vec3 to_centre = world_from_object(ball.centre) - ray.origin;
    const double squared = glm::dot(ray.direction, ray.direction);
    const double middle = glm::dot(to_centre, ray.direction) / squared;
    const Vec3 off = to_centre - middle * ray.direction;
    const double half_squared = (radius * radius - glm::dot(off, off)) / squared;
    if (half_squared < 0 || middle + std::sqrt(half_squared) < 0) return std::nullopt;
    return std::max(middle - std::sqrt(half_squared), 0.0);
}

class PartRay {
  public:
    PartRay(const ViewedModel& model, const Ray& ray, double least_px)
        : graph_(model.model->graph), components_(model.model->components), bounds_(model.model->bounds),
          steps_(model.steps), view_(model.view), ray_(ray), least_px_(least_px) {}

    std::optional<MetPart> run(std::uint64_t most_looks) {
        push({graph_.root, {}, 0, no_place, {}});
        for (std::uint64_t looks = 0; !waiting_.empty() && looks < most_looks; ++looks) {
            const auto [enters, number] = waiting_.top();
            waiting_.pop();
            if (enters >= best_t_) break;
            look(number, enters);
        }
        if (best_ == no_place) return std::nullopt;
        MetPart met{best_t_, ray_(best_t_), best_normal_, {}};
        for (std::uint32_t place = best_; places_[place].before != no_place; place = places_[place].before)
            met.path.push_back(places_[place].step);
        std::ranges::reverse(met.path);
        return met;
    }

  private:
    struct Place {
        ObjectId object = 0;
        Affine world_from_object;
        std::uint32_t levels = 0;
        std::uint32_t before = no_place;
        GraphStep step; ///< that leads here
    };
    using Waiting = std::pair<double, std::uint32_t>; ///< where the ray goes in; number of the place

    void push(const Place& place) {
        const ObjectBounds& bounds = bounds_[place.object];
        std::optional<double> enters;
        if (bounds.unbounded)
            enters = 0;
        else if (bounds.box.empty())
            return;
        else if (is_singular(place.world_from_object))
            enters = entry(bounds.ball, place.world_from_object, ray_);
        else
            enters = entry(bounds.box, in_frame(place.world_from_object));
        if (!enters || *enters >= best_t_) return;
        places_.push_back(place);
        waiting_.push({*enters, static_cast<std::uint32_t>(places_.size() - 1)});
    }

    Ray in_frame(const Affine& world_from_object) const {
        const Affine object_from_world = inverse(world_from_object);
        return {object_from_world(ray_.origin), object_from_world.linear * ray_.direction};
    }

    void look(std::uint32_t number, double enters) {
        const Place place = places_[number];
        const Object& object = graph_.objects[place.object];
        if (object.primitive) return meet(number, *object.primitive, enters);
        const bool ended = steps_ && components_.unending[place.object] && place.levels >= *steps_;
        if (object.packed || object.is_combined() || ended || is_small(place, enters))
            return take(number, enters, -ray_.direction);
        for (std::uint32_t i = 0; i < object.instances.size(); ++i) {
            const Instance& instance = object.instances[i];
            const std::uint32_t levels = place.levels + levels_of(instance, components_);
            if (steps_ && levels > *steps_) continue;
            push({instance.master,
                  place.world_from_object * instance.parent_from_child,
                  levels,
                  number,
                  {place.object, i}});
        }
    }

    bool is_small(const Place& place, double enters) const {
        const double diameter =
            2 * norm(place.world_from_object.linear) * std::max(bounds_[place.object].ball.radius, 0.0);
        return !bounds_[place.object].unbounded &&
               diameter * view_.camera.pixels_per_unit(ray_(enters), view_.size.width) <= least_px_;
    }

    void meet(std::uint32_t number, const Primitive& primitive, double enters) {
        const Affine& map = places_[number].world_from_object;
        if (is_singular(map)) return take(number, enters, -ray_.direction);
        Ray local = in_frame(map);
        const double largest = largest_entry(local.direction);
        if (!(largest > 0)) return;
        local.origin = local(enters);
        local.direction /= largest;
        PrimitiveHit hit;
        constexpr double before_box = -1e-6;
        if (!intersect(primitive, local, {before_box, best_t_ * largest}, hit)) return;
        take(number, std::max(enters + hit.t / largest, 0.0),
             glm::transpose(inverse(map).linear) * hit.normal);
    }

    void take(std::uint32_t number, double t, Vec3 normal) {
        if (t >= best_t_) return;
        best_t_ = t;
        best_ = number;
        best_normal_ = glm::normalize(glm::dot(normal, ray_.direction) > 0 ? -normal : normal);
    }

    const Graph& graph_;
    const Components& components_;
    const std::vector<ObjectBounds>& bounds_;
    std::optional<unsigned> steps_;
    const View& view_;
    const Ray ray_;
    const double least_px_;
    std::vector<Place> places_;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
    double best_t_ = std::numeric_limits<double>::infinity();
    std::uint32_t best_ = no_place;
    Vec3 best_normal_{0, 1, 0};
};

} // namespace

std::optional<MetPart> first_part(const ViewedModel& model, const Ray& ray, double least_px,
                                  std::uint64_t most_looks) {
    return PartRay(model, ray, least_px).run(most_looks);
}

Affine world_from_end(const Graph& graph, const std::vector<GraphStep>& path) {
    Affine world_from_object;
    for (const GraphStep& step : path)
        world_from_object =
            world_from_object * graph.objects[step.object].instances[step.instance].parent_from_child;
    return world_from_object;
}

ObjectId end_of(const Graph& graph, const std::vector<GraphStep>& path) {
    if (path.empty()) return graph.root;
    const GraphStep& last = path.back();
    return graph.objects[last.object].instances[last.instance].master;
}

} // namespace graftal
