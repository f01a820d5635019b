#pragma once

// Traversal past specks, which stand for small parts of sets without area. Specks are drawn wider than they
// are, so that a ray comes near many and meets few. Only traversal.cpp includes this.

#include "runtime/trace/model/specks.h"
#include "runtime/trace/traverse/kernel.h"

namespace graftal {

template<Instructions instructions, bool any>
GRAFTAL_INLINE std::uint32_t Traversal::Kernel<instructions, any>::specks_near(const SpeckLanes& specks,
                                                                               const LocalRay& ray,
                                                                               double half_width) const {
    // Error of the world's coordinates, in the frame.
    const double rounding =
        1e-9 + 1e-14 * ray.speed * (std::abs(ray.base) + largest_component(lanes_of(self.ray_.origin)));
    Double4 from_ray[3], direction[3], along[3];
    for (int axis = 0; axis < 3; ++axis) {
        direction[axis] = splat(ray.direction[axis]);
        from_ray[axis] = specks.middle[axis] - splat(ray.origin[axis]);
        along[axis] = specks.normal[axis] + specks.ball * direction[axis]; // a ball's plane faces the ray
    }
    const auto dot = [](const Double4* a, const Double4* b)
                         GRAFTAL_INLINED_LAMBDA { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const Double4 inverse = 1 / dot(direction, along);
    const Double4 t = dot(from_ray, along) * inverse;
    const Double4 loose = splat(2 * rounding) * (inverse < 0 ? -inverse : inverse);
    const Double4 wide = splat(half_width) * specks.reach;
    const Double4 radius = (specks.radius > wide ? specks.radius : wide) + loose;
    Double4 aside[3];
    for (int axis = 0; axis < 3; ++axis)
        aside[axis] = t * direction[axis] - from_ray[axis];
    const Double4 deep = specks.ball * radius + loose;
    const RayRange near = range_from(ray.base, ray.speed);
    const std::uint32_t lanes =
        bits_of<instructions>((dot(aside, aside) <= radius * radius) & (t - deep <= splat(near.most)) &
                              (t + deep >= splat(near.least)));
    if (lanes == 0) return 0;
    const Double4 half = 0.5 * radius + loose;
    return lanes &
           bits_of<instructions>((dot(aside, specks.side[0]) <= half) & (dot(aside, specks.side[1]) <= half) &
                                 (dot(aside, specks.side[2]) <= half));
}

template<Instructions instructions, bool any>
GRAFTAL_INLINE bool Traversal::Kernel<instructions, any>::misses_specks(const TraceNode& node,
                                                                        const LocalRay& ray,
                                                                        double half_width) const {
    for (std::uint32_t i = 0; i < node.speck_count; ++i)
        if (specks_near(model.specks[node.first_speck + i], ray, half_width) != 0) return false;
    self.lose_patience(node.stop_edge_count);
    return true;
}

template<Instructions instructions, bool any>
GRAFTAL_INLINE void Traversal::Kernel<instructions, any>::meet_specks(const TraceNode& node,
                                                                      std::uint32_t frame_number) {
    const std::uint32_t first_edge = node.first_edge + node.edge_count;
    for (std::uint32_t i = 0; i < node.speck_count; ++i) {
        const Frame& frame = frames[frame_number];
        std::uint32_t lanes = specks_near(model.specks[node.first_speck + i], frame, frame.margin.x);
        const std::uint32_t held = std::min(4u, node.stop_edge_count - std::min(node.stop_edge_count, 4 * i));
        self.lose_patience(held - std::min(held, static_cast<std::uint32_t>(std::popcount(lanes))));
        for (; lanes != 0; lanes &= lanes - 1) {
            ++self.visits_;
            const std::uint32_t edge =
                first_edge + 4 * i + static_cast<std::uint32_t>(std::countr_zero(lanes));
            meet_faint(model.nodes[model.edges[edge].child], model.edges[edge], frame,
                       {0, edge, frame_number});
            if (any && self.best_.found) return;
        }
    }
}

} // namespace graftal
