#include "runtime/trace/model/near_enough.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/least_width.h"
#include "compiler/primitives/primitive.h"
#include "runtime/trace/model/trace_model.h"

namespace graftal {

namespace {

/// The farthest that a box reaches from a point, by axis.
Vec3 reach_from(Vec3 point, const Box& box) {
    return glm::max(glm::abs(box.min - point), glm::abs(box.max - point));
}

/// Farthest reach of terminals from the middle of the part that they stand for, where it is just cut, in
/// lengths of the error.
double farthest_terminal(const TraceModel& model) {
    double farthest = 0;
    for (const TraceNode& node : model.nodes)
        for (std::uint32_t i = 0; i < node.stop_edge_count; ++i) {
            const Box& box = model.edges[node.first_edge + node.edge_count + i].box;
            if (!(node.ball_radius > 0) || box.empty()) continue;
            const Vec3 corner = reach_from(vec3_of(node.ball_centre), box);
            farthest = std::max(farthest, 0.5 * node.cut_detail * glm::length(corner) / node.ball_radius);
        }
    return farthest;
}

/// Whether the map takes the axis onto itself, and what lies across it onto what does.
bool keeps_axis(const Mat3& map, int axis) {
    constexpr double rounding = 1e-9;
    const double unseen = rounding * largest_entry(map);
    for (int other = 0; other < 3; ++other)
        if (other != axis && !(std::abs(map[axis][other]) <= unseen && std::abs(map[other][axis]) <= unseen))
            return false;
    return true;
}

/// Farthest reach along the axis from the middle of a part that is widened in all directions, in half widths:
/// that of its box, or of its ball where some map turns the axis.
double farthest_widened(const TraceModel& model, int axis) {
    const auto turns = [&](const TraceEdge& edge) {
        return !keeps_axis(linear_of(edge.parent_from_child), axis);
    };
    const bool turned = std::ranges::any_of(
        model.edges, [&](const TraceEdge& edge) { return !edge.to_primitive && turns(edge); });
    double farthest = 1; // a proxy
    for (const TraceEdge& edge : model.edges) {
        const Primitive& primitive = model.nodes[edge.child].primitive;
        if (!edge.to_primitive || primitive == PrimitiveKind::plane) continue;
        const PrimitiveTraits& traits = traits_of(primitive);
        farthest = std::max(farthest, turned || turns(edge) ? widened_reach(primitive)
                                                            : reach_from(traits.ball(primitive).centre,
                                                                         traits.box(primitive))[axis] /
                                                                  traits.inner_radius(primitive));
    }
    return farthest;
}

} // namespace

NearEnough::NearEnough(const TraceModel& model) {
    const Box& box = model.prepared.bounds;
    if (!(model.most_half_width > 0) || model.prepared.root_steps != unlimited_steps || box.empty()) return;
    const double most_thickness = 0.1 * model.most_half_width;
    while (++axis_ < 3 && box.size()[axis_] > most_thickness) {
    }
    if (axis_ == 3) {
        axis_ = -1;
        return;
    }
    middle_ = box.centre()[axis_];
    widened_reach_ = farthest_widened(model, axis_);
    terminal_reach_ = farthest_terminal(model);
}

double NearEnough::distance(const TraceModel& model, const Ray& ray, double share) const {
    constexpr double before_all = -std::numeric_limits<double>::infinity();
    if (axis_ < 0 || ray.direction[axis_] == 0) return before_all;
    const double slope = std::abs(ray.direction[axis_]);
    const double middle = (middle_ - ray.origin[axis_]) / ray.direction[axis_];
    const Ball here{ray(middle), 2 * model.most_half_width};
    const double half_width = std::min(model.most_half_width, model.projection.most_half_width(here));
    const double height =
        std::max(widened_reach_ * half_width, terminal_reach_ / model.projection.detail_per_unit(here));
    return middle - height / slope + share * half_width / glm::length(ray.direction);
}

} // namespace graftal
