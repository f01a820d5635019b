#pragma once

// Intersections of a packet with primitives, four rays at a time. Only packets.cpp includes this.

#include "compiler/primitives/passage.h"
#include "runtime/trace/traverse/packet.h"

namespace graftal {

/// Crosses a cube by the operations of the primitive (cube.cpp), with rays that are parallel to no side.
template<Instructions instructions>
GRAFTAL_INLINE auto Traversal::Packet<instructions>::cross_cube(const Near& near, const Double4 (&inverse)[3])
    -> Crossing {
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
template<Instructions instructions>
GRAFTAL_INLINE auto Traversal::Packet<instructions>::cross_triangle(const Near& near) -> Crossing {
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

template<Instructions instructions>
GRAFTAL_INLINE void Traversal::Packet<instructions>::ready_range(Near& near, int half) const {
    near.least = (range.least - near.base) * near.speed;
    near.most = (best.half[half] - near.base) * near.speed;
}

template<Instructions instructions>
GRAFTAL_INLINE void Traversal::Packet<instructions>::meet_proxy(const TraceNode& node, const Frame& frame,
                                                                const Going& going) {
    const LaneMap& map = node.proxy_from_node;
    Near near[2];
    Crossing crossing[2];
    for (int i = 0; i < 2; ++i) {
        Near& n = near[i];
        const Double4 from[3] = {frame.origin[0].half[i], frame.origin[1].half[i], frame.origin[2].half[i]},
                      to[3] = {direction[0].half[i], direction[1].half[i], direction[2].half[i]};
        for (int axis = 0; axis < 3; ++axis) {
            n.origin[axis] = through(map, from[0], from[1], from[2], axis) + splat(map.translation[axis]);
            n.along[axis] = through(map, to[0], to[1], to[2], axis);
        }
        const Double4 growth = largest_of(n.along[0], n.along[1], n.along[2]), stretch = 1 / growth;
        for (int axis = 0; axis < 3; ++axis)
            n.along[axis] = n.along[axis] * stretch;
        n.base = frame.base.half[i];
        n.is_map = n.base == n.base;
        n.unit = frame.unit.half[i] * stretch;
        n.speed = frame.speed.half[i] * growth;
        ready_range(n, i);
        crossing[i] = cross_any(PrimitiveKind::sphere, n, i, going.mask);
        crossing[i].in_world = n.base + crossing[i].t * n.unit;
    }
    if (!keep_crossings(near, crossing, going.mask)) return;
    PacketRoom::Hit& hit = room.hits.back();
    hit.proxy_node = frame.node;
    place(frame, node.node_from_proxy, hit.world_from_leaf);
    keep_way(going.frame + 1, hit);
    hit.way_end = room.ways.size();
}

/// Meets a sphere by the operations of the primitive (sphere.cpp), until it is known which rays pass.
template<Instructions instructions>
GRAFTAL_INLINE std::uint32_t Traversal::Packet<instructions>::passing_sphere(const Near& near) {
    const auto dot = [](const Double4(&a)[3], const Double4(&b)[3])
                         GRAFTAL_INLINED_LAMBDA { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const Double4 middle = -dot(near.origin, near.along) / dot(near.along, near.along);
    Double4 point[3];
    for (int axis = 0; axis < 3; ++axis)
        point[axis] = near.origin[axis] + middle * near.along[axis];
    return bits_of<instructions>(1 - dot(point, point) < 0);
}

template<Instructions instructions>
GRAFTAL_INLINE auto Traversal::Packet<instructions>::cross_any(const Primitive& primitive, const Near& near,
                                                               int half, std::uint32_t mask) const
    -> Crossing {
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
        const RayRange within{near.least[j], near.most[j] < INFINITY ? near.most[j] + slack : near.most[j]};
        PrimitiveHit hit;
        if (!self.meet_within(primitive, {here(near.origin), here(near.along)}, within, hit,
                              TraceModel::usual_visits))
            continue;
        crossing.t[j] = hit.t;
        for (int axis = 0; axis < 3; ++axis)
            crossing.normal[axis][j] = hit.normal[axis];
        crossing.crossed[j] = -1;
    }
    return crossing;
}

template<Instructions instructions>
GRAFTAL_INLINE bool Traversal::Packet<instructions>::keep_crossings(const Near (&near)[2],
                                                                    const Crossing (&crossing)[2],
                                                                    std::uint32_t mask) {
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

template<Instructions instructions>
GRAFTAL_INLINE void Traversal::Packet<instructions>::meet_leaf(const EvenPart& part, const Going& going) {
    count(going);
    const TraceEdge& edge = model.edges[going.entry];
    Near near[2];
    Crossing crossing[2];
    for (int i = 0; i < 2; ++i) {
        near[i] = bring_near(part, edge, going, i);
        const Double4 over[3] = {inverse[0].half[i], inverse[1].half[i], inverse[2].half[i]};
        crossing[i] = part.kind == EvenPart::Kind::cube ? cross_cube(near[i], over)
                      : part.kind == EvenPart::Kind::triangle
                          ? cross_triangle(near[i])
                          : cross_any(model.nodes[part.child].primitive, near[i], i, going.mask);
        crossing[i].in_world = near[i].base + crossing[i].t * near[i].unit;
    }
    if (!keep_crossings(near, crossing, going.mask)) return;
    PacketRoom::Hit& hit = room.hits.back();
    const Frame& parent = frames[going.frame];
    hit.is_upright = part.upright && !room.has_patterns;
    if (!hit.is_upright) place(parent, edge.parent_from_child, hit.world_from_leaf);
    if (room.has_textures) hit.turns = edge.turns;
    prefetch_look(going.entry);
    keep_way(going.frame, hit);
    room.ways.push_back(going.entry | (parent.cut ? from_cut : 0));
    hit.way_end = room.ways.size();
}

template<Instructions instructions>
GRAFTAL_INLINE auto Traversal::Packet<instructions>::bring_near(const EvenPart& part, const TraceEdge& edge,
                                                                const Going& going, int half) const -> Near {
    const Frame& parent = frames[going.frame];
    const Double4 at = doubles_of(going.at, half);
    Near near;
    near.base = parent.base.half[half] + at * parent.unit.half[half];
    Double4 from[3];
    for (int axis = 0; axis < 3; ++axis)
        from[axis] = parent.origin[axis].half[half] + at * direction[axis].half[half];
    Double4 growth = splat(part.growth), stretch = splat(part.stretch);
    near.is_map = growth == growth;
    if (part.upright) {
        for (int axis = 0; axis < 3; ++axis) {
            near.origin[axis] = from[axis] * splat(part.shrink()) + splat(part.shift[axis]);
            near.along[axis] = direction[axis].half[half];
        }
    } else {
        const LaneMap& map = edge.child_from_parent;
        for (int axis = 0; axis < 3; ++axis) {
            near.origin[axis] = through(map, from[0], from[1], from[2], axis) + splat(map.translation[axis]);
            near.along[axis] =
                through(map, direction[0].half[half], direction[1].half[half], direction[2].half[half], axis);
        }
        if (!edge.similarity) {
            growth = largest_of(near.along[0], near.along[1], near.along[2]);
            near.is_map = (growth > splat(0.0)) & (growth < splat(1 / least_scale));
            stretch = 1 / growth;
        }
        for (int axis = 0; axis < 3; ++axis)
            near.along[axis] = near.along[axis] * stretch;
    }
    near.unit = parent.unit.half[half] * stretch;
    near.speed = parent.speed.half[half] * growth;
    ready_range(near, half);
    return near;
}

} // namespace graftal
