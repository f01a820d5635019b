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
double farthest_terminal(const TraceBasis& basis, double error_px) {
    double farthest = 0;
    for (std::size_t id = 0; id < basis.bounds.stop_edge.size(); ++id) {
        const DetailNode& node = basis.layers.cut.nodes[id];
        for (const Box& box : basis.bounds.stop_edge[id]) {
            if (!(node.ball.radius > 0) || box.empty()) continue;
            const double corner = glm::length(reach_from(node.ball.centre, box));
            farthest = std::max(farthest, 0.5 * cut_detail(node, error_px) * corner / node.ball.radius);
        }
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
double farthest_widened(const DetailGraph& cut, int axis) {
    bool turned = false;
    const auto for_each_edge = [&](const auto& visit) {
        for (const DetailNode& node : cut.nodes) {
            std::ranges::for_each(node.edges, visit);
            std::ranges::for_each(node.stop_edges, visit);
        }
    };
    const auto turns = [&](const DetailEdge& edge) { return !keeps_axis(edge.node_from_child.linear, axis); };
    for_each_edge([&](const DetailEdge& edge) {
        turned = turned || (!cut.nodes[edge.child].primitive && turns(edge));
    });
    double farthest = 1; // a proxy
    for_each_edge([&](const DetailEdge& edge) {
        const std::optional<Primitive>& primitive = cut.nodes[edge.child].primitive;
        if (!primitive || *primitive == PrimitiveKind::plane) return;
        const PrimitiveTraits& traits = traits_of(*primitive);
        const Vec3 reach = reach_from(traits.ball(*primitive).centre, traits.box(*primitive));
        farthest = std::max(farthest, turned || turns(edge) ? widened_reach(*primitive)
                                                            : reach[axis] / traits.inner_radius(*primitive));
    });
    for (const DetailNode& node : cut.nodes) // items of runs are turned in any way
        if (node.cell)
            for (const NodeId child : node.cell->source->child)
                if (const auto& primitive = cut.nodes[child].primitive;
                    primitive && *primitive != PrimitiveKind::plane)
                    farthest = std::max(farthest, widened_reach(*primitive));
    return farthest;
}

} // namespace

NearEnough::NearEnough(const PreparedGraph& prepared, const TraceBasis& basis, double most_half_width,
                       double error_px) {
    const Box& box = prepared.bounds;
    if (!(most_half_width > 0) || prepared.root_steps != unlimited_steps || box.empty()) return;
    const double most_thickness = 0.1 * most_half_width;
    while (++axis < 3 && box.size()[axis] > most_thickness) {
    }
    if (axis == 3) {
        axis = -1;
        return;
    }
    middle = box.centre()[axis];
    widened_reach = farthest_widened(basis.layers.cut, axis);
    terminal_reach = farthest_terminal(basis, error_px);
}

double NearEnough::distance(const TraceModel& model, const Ray& ray, double share) const {
    constexpr double before_all = -std::numeric_limits<double>::infinity();
    if (axis < 0 || ray.direction[axis] == 0) return before_all;
    const double slope = std::abs(ray.direction[axis]);
    const double at = (middle - ray.origin[axis]) / ray.direction[axis];
    const Ball here{ray(at), 2 * model.most_half_width};
    const double half_width = std::min(model.most_half_width, model.projection.most_half_width(here));
    const double height =
        std::max(widened_reach * half_width, terminal_reach / model.projection.detail_per_unit(here));
    return at - height / slope + share * half_width / glm::length(ray.direction);
}

} // namespace graftal
