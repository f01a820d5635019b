#pragma once

// Intersections of a packet with primitives, four rays at a time. Only packets.cpp includes this.

#include "compiler/primitives/passage.h"
#include "runtime/trace/traverse/packet.h"

namespace graftal {

/// Crosses a cube by the operations of the primitive (cube.cpp), with rays that are parallel to no side.
template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
GRAFTAL_INLINE auto Traversal::PacketWalk<instructions, Packet, PlacesOf, FrameOf>::cross_cube(
    const Near& near, const Double4 (&inverse)[3]) -> Crossing {
    Double4 enter[3], leave[3];
    for (int axis = 0; axis < 3; ++axis) {
        const Double4 a = (-1 - near.origin[axis]) * inverse[axis],
                      b = (1 - near.origin[axis]) * inverse[axis];
        enter[axis] = b < a ? b : a;
        leave[axis] = a < b ? b : a;
    }
    const Double4 enter_xy = enter[0] < enter[1] ? enter[1] : enter[0],
                  leave_xy = leave[1] < leave[0] ? leave[1] : leave[0];
    const Double4 enters = enter_xy < enter[2] ? enter[2] : enter_xy,
                  leaves = leave[2] < leave_xy ? leave[2] : leave_xy;
    const Long4 entering = enters > near.least;
    Crossing crossing;
    crossing.t = entering ? enters : leaves;
    crossing.crossed = (enters <= leaves) & (crossing.t > near.least);
    Long4 here = crossing.t == (entering ? enter[0] : leave[0]), other = ~here;
    for (int axis = 0; axis < 3; ++axis) {
        const Double4 outwards = ((near.along[axis] < 0) ^ entering) != 0 ? splat(-1.0) : splat(1.0);
        crossing.normal[axis] = here ? outwards : splat(0.0);
        here = axis == 0 ? other & (crossing.t == (entering ? enter[1] : leave[1])) : other & ~here;
        other = other & ~here;
    }
    return crossing;
}

/// Likewise (triangle.cpp).
template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
GRAFTAL_INLINE auto
Traversal::PacketWalk<instructions, Packet, PlacesOf, FrameOf>::cross_triangle(const Near& near) -> Crossing {
    constexpr double root3 = 1.7320508075688772;
    Crossing crossing;
    const Double4 t = -near.origin[2] / near.along[2];
    const Double4 x = near.origin[0] + t * near.along[0], y = near.origin[1] + t * near.along[1];
    crossing.t = t;
    crossing.crossed = (t > near.least) & (y >= splat(-0.5 - passage_rounding)) &
                       (root3 * size_of(x) + y <= splat(1 + passage_rounding));
    crossing.normal[0] = crossing.normal[1] = splat(0.0);
    crossing.normal[2] = splat(1.0);
    return crossing;
}

template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
GRAFTAL_INLINE void
Traversal::PacketWalk<instructions, Packet, PlacesOf, FrameOf>::ready_range(Near& near, int half) const {
    near.least = (least.half[half] - near.base) * near.speed;
    near.most = (best.half[half] - near.base) * near.speed;
}

/// Kernel::meet_proxy() for a packet.
template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
GRAFTAL_INLINE bool Traversal::PacketWalk<instructions, Packet, PlacesOf, FrameOf>::meet_proxy(
    const TraceNode& node, Near (&near)[2], std::uint32_t mask) {
    const LaneMap& map = node.proxy_from_node;
    Crossing crossing[2];
    for (int i = 0; i < 2; ++i) {
        Near& n = near[i];
        Double4 origin[3], along[3];
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis] =
                through(map, n.origin[0], n.origin[1], n.origin[2], axis) + splat(map.translation[axis]);
            along[axis] = through(map, n.along[0], n.along[1], n.along[2], axis);
        }
        const Double4 growth = largest_of(along[0], along[1], along[2]), stretch = 1 / growth;
        for (int axis = 0; axis < 3; ++axis) {
            n.origin[axis] = origin[axis];
            n.along[axis] = along[axis] * stretch;
        }
        n.unit = n.unit * stretch;
        n.speed = n.speed * growth;
        ready_range(n, i);
        crossing[i] = cross_any(PrimitiveKind::sphere, n, i, mask);
        crossing[i].in_world = n.base + crossing[i].t * n.unit;
    }
    return keep_crossings(near, crossing, mask);
}

/// Meets a sphere by the operations of the primitive (sphere.cpp), until it is known which rays pass.
template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
GRAFTAL_INLINE std::uint32_t
Traversal::PacketWalk<instructions, Packet, PlacesOf, FrameOf>::passing_sphere(const Near& near) {
    const auto dot = [](const Double4(&a)[3], const Double4(&b)[3])
                         GRAFTAL_INLINED_LAMBDA { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const Double4 middle = -dot(near.origin, near.along) / dot(near.along, near.along);
    Double4 point[3];
    for (int axis = 0; axis < 3; ++axis)
        point[axis] = near.origin[axis] + middle * near.along[axis];
    return bits_of<instructions>(1 - dot(point, point) < 0);
}

template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
GRAFTAL_INLINE auto Traversal::PacketWalk<instructions, Packet, PlacesOf, FrameOf>::cross_any(
    const Primitive& primitive, const Near& near, int half, std::uint32_t mask) const -> Crossing {
    Crossing crossing{};
    std::uint32_t may = bits_of<instructions>(near.is_map);
    if (primitive == PrimitiveKind::sphere) may &= ~passing_sphere(near);
    for (std::uint32_t left = mask >> (4 * half) & may & 15; left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        const auto here = [&](const Double4(&lanes)[3]) {
            return Vec3(lanes[0][j], lanes[1][j], lanes[2][j]);
        };
        // Also what lies so little beyond the best hit that it may be as near.
        const double slack =
            2 * rounding * (std::abs(best.half[half][j]) + std::abs(near.base[j])) * near.speed[j];
        const RayRange range{near.least[j], near.most[j] < INFINITY ? near.most[j] + slack : near.most[j]};
        PrimitiveHit hit;
        if (!self.meet_within(primitive, {here(near.origin), here(near.along)}, range, hit,
                              TraceModel::usual_visits))
            continue;
        crossing.t[j] = hit.t;
        for (int axis = 0; axis < 3; ++axis)
            crossing.normal[axis][j] = hit.normal[axis];
        crossing.crossed[j] = -1;
    }
    return crossing;
}

template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
GRAFTAL_INLINE bool Traversal::PacketWalk<instructions, Packet, PlacesOf, FrameOf>::keep_crossings(
    const Near (&near)[2], const Crossing (&crossing)[2], std::uint32_t mask) {
    Double8 t;
    std::uint32_t hit = 0, close = 0;
    for (int i = 0; i < 2; ++i) {
        const Long4 crossed = crossing[i].crossed & near[i].is_map;
        t.half[i] = crossing[i].in_world;
        hit |= bits_of<instructions>(crossed & (crossing[i].t < near[i].most)) << (4 * i);
        const Double4 slack = rounding * (size_of(t.half[i]) + size_of(near[i].base));
        close |= bits_of<instructions>(crossed & (size_of(t.half[i] - best.half[i]) <= slack)) << (4 * i);
    }
    hit &= mask;
    found |= hit;
    tied = (tied & ~hit) | (close & mask);
    if (hit == 0) return false;
    for (; hit != 0; hit &= hit - 1) {
        const int lane = std::countr_zero(hit), i = lane / 4, j = lane % 4;
        best.half[i][j] = t.half[i][j];
        const Crossing& c = crossing[i];
        const Near& n = near[i];
        PacketRoom::Best& to = room.best[static_cast<std::size_t>(lane)];
        to.t = t.half[i][j];
        to.hit = room.hits.size();
        to.normal = {c.normal[0][j], c.normal[1][j], c.normal[2][j]};
        for (int axis = 0; axis < 3; ++axis)
            to.point[axis] = n.origin[axis][j] + c.t[j] * n.along[axis][j];
    }
    room.hits.emplace_back();
    return true;
}

} // namespace graftal
