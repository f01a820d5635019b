#include "runtime/trace/model/surface_normal.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "compiler/detail/mesh/limit_normal.h"
#include "compiler/support/stretch.h"

namespace graftal {

Vec3 transformed_normal(const LaneMap& map, Vec3 normal) {
    Mat3 m = map.affine().linear;
    if (m == Mat3(m[0][0]) && m[0][0] > 0) return glm::normalize(normal);
    const double largest = largest_entry(m);
    m /= largest;
    // The cofactors are the inverse transposed, up to a factor, the determinant.
    const Vec3 n = normal.x * glm::cross(m[1], m[2]) + normal.y * glm::cross(m[2], m[0]) +
                   normal.z * glm::cross(m[0], m[1]);
    const double length = glm::length(n);
    if (!(length > 0)) return normal;
    return (glm::dot(m[0], glm::cross(m[1], m[2])) < 0 ? -1.0 : 1.0) / length * n;
}

Vec3 limit_normal(const TraceModel& model, std::span<const std::uint32_t> path, std::uint32_t node,
                  Vec3 point) {
    const LaneMap& node_from_proxy = model.nodes[node].node_from_proxy;
    Vec3 at = node_from_proxy.affine()(point);
    Vec3 sum = transformed_normal(node_from_proxy, point);
    int level = 0;
    double weight = 1;
    for (std::size_t i = path.size(); i-- > 0;) {
        const TraceEdge& edge = model.edges[path[i] & ~from_cut];
        const double length = glm::length(sum);
        if (!(length > 0)) return transformed_normal(node_from_proxy, point);
        sum = length * transformed_normal(edge.parent_from_child, sum / length);
        if (i == 0 || level == limit_normal_levels) continue;
        at = edge.parent_from_child.affine()(at);
        const TraceNode& parent = model.nodes[model.edges[path[i - 1] & ~from_cut].child];
        if (!parent.unending) continue;
        ++level;
        weight /= limit_normal_ratio;
        if (parent.ball_radius > 0) // a limit may be one point
            sum += weight / parent.ball_radius * (at - vec3_of(parent.ball_centre));
    }
    return glm::normalize(sum);
}

Vec3 limit_normal_in_world(const TraceModel& model, std::span<const std::uint32_t> path, Vec3 normal,
                           Vec3 point) {
    // The paths into deep limits have hundreds of nodes, of which the last few count.
    const auto edge = [&](std::size_t i) -> const TraceEdge& { return model.edges[path[i] & ~from_cut]; };
    const std::size_t end = path.size() - std::min<std::size_t>(path.size(), 1);
    std::size_t begin = end;
    for (int levels = 0; begin > 0 && levels < limit_normal_levels; --begin)
        levels += model.nodes[edge(begin - 1).child].unending ? 1 : 0;
    Affine world_from_node;
    for (std::size_t i = 0; i < begin; ++i)
        world_from_node = world_from_node * edge(i).parent_from_child.affine();
    std::array<Ball, limit_normal_levels> balls; // of the unending nodes above the proxy
    int levels = 0;
    for (std::size_t i = begin; i < end; ++i) {
        world_from_node = world_from_node * edge(i).parent_from_child.affine();
        const TraceNode& node = model.nodes[edge(i).child];
        if (node.unending)
            balls[static_cast<std::size_t>(levels++)] = {world_from_node(vec3_of(node.ball_centre)),
                                                         largest_stretch(world_from_node.linear) *
                                                             node.ball_radius};
    }
    NormalField field;
    for (int level = 1; level <= levels; ++level) {
        const Ball& ball = balls[static_cast<std::size_t>(levels - level)];
        field.add(level, ball.centre, ball.radius);
    }
    const Vec3 sum = normal + field.at(point);
    const double length = glm::length(sum);
    return length > 1e-6 ? sum / length : normal;
}

} // namespace graftal
