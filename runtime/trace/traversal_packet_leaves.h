#pragma once

// How a packet of rays meets cubes and triangles, four rays at a time. Only traversal.cpp includes this.

#include "runtime/trace/traversal_packet.h"

namespace graftal {

template<Instructions instructions>
GRAFTAL_INLINE typename Traversal::EvenPacket<instructions>::Near
Traversal::EvenPacket<instructions>::bring_near(const EvenPart& part, const TraceEdge& edge,
                                                const Going& going, int half) const {
    const Frame& parent = room.frames[going.frame];
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
        const auto through = [&](const Double4& x, const Double4& y, const Double4& z, int axis)
                                 GRAFTAL_INLINED_LAMBDA {
                                     return splat(map.column[0][axis]) * x + splat(map.column[1][axis]) * y +
                                            splat(map.column[2][axis]) * z;
                                 };
        for (int axis = 0; axis < 3; ++axis) {
            near.origin[axis] = through(from[0], from[1], from[2], axis) + splat(map.translation[axis]);
            near.along[axis] =
                through(direction[0].half[half], direction[1].half[half], direction[2].half[half], axis);
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
    const Double4 speed = parent.speed.half[half] * growth;
    near.least = (range.least - near.base) * speed;
    near.most = (best.half[half] - near.base) * speed;
    return near;
}

/// As EvenKernel::meet_cube().
template<Instructions instructions>
GRAFTAL_INLINE typename Traversal::EvenPacket<instructions>::Crossing
Traversal::EvenPacket<instructions>::cross_cube(const Near& near, int half) const {
    Double4 enter[3], leave[3];
    for (int axis = 0; axis < 3; ++axis) {
        const Double4 a = (-1 - near.origin[axis]) * inverse[axis].half[half],
                      b = (1 - near.origin[axis]) * inverse[axis].half[half];
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

/// As EvenKernel::meet_triangle().
template<Instructions instructions>
GRAFTAL_INLINE typename Traversal::EvenPacket<instructions>::Crossing
Traversal::EvenPacket<instructions>::cross_triangle(const Near& near) {
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
GRAFTAL_INLINE void Traversal::EvenPacket<instructions>::meet_leaf(const EvenPart& part, const Going& going) {
    count(going);
    const TraceEdge& edge = model.edges[going.entry];
    Near near[2];
    Crossing crossing[2];
    Double8 t;
    std::uint32_t hit = 0, close = 0;
    for (int i = 0; i < 2; ++i) {
        near[i] = bring_near(part, edge, going, i);
        crossing[i] = part.kind == EvenPart::Kind::cube ? cross_cube(near[i], i) : cross_triangle(near[i]);
        const Long4 crossed = crossing[i].crossed & near[i].is_map;
        t.half[i] = near[i].base + crossing[i].t * near[i].unit;
        hit |= bits_of<instructions>(crossed & (crossing[i].t < near[i].most)) << (4 * i);
        const Double4 slack = rounding * (size_of(t.half[i]) + size_of(near[i].base));
        close |= bits_of<instructions>(crossed & (size_of(t.half[i] - best.half[i]) <= slack)) << (4 * i);
    }
    hit &= going.mask;
    tied = (tied & ~hit) | (close & going.mask);
    if (hit == 0) return;
    found |= hit;
    const std::size_t number = keep_hit(part, going);
    for (; hit != 0; hit &= hit - 1) {
        const int lane = std::countr_zero(hit), i = lane / 4, j = lane % 4;
        best.half[i][j] = t.half[i][j];
        const Crossing& c = crossing[i];
        const Near& n = near[i];
        PacketRoom::Best& to = room.best[static_cast<std::size_t>(lane)];
        to.t = t.half[i][j];
        to.hit = number;
        to.normal = {c.normal[0][j], c.normal[1][j], c.normal[2][j]};
        for (int axis = 0; axis < 3; ++axis)
            to.point[axis] = n.origin[axis][j] + c.t[j] * n.along[axis][j];
    }
}

/// What the rays share that hit an entry's leaf.
template<Instructions instructions>
GRAFTAL_INLINE std::size_t Traversal::EvenPacket<instructions>::keep_hit(const EvenPart& part,
                                                                         const Going& going) {
    const Frame& parent = room.frames[going.frame];
    PacketRoom::Hit& hit = room.hits.emplace_back();
    hit.is_upright = part.upright;
    if (!part.upright) place(parent, model.edges[going.entry].parent_from_child, hit.world_from_leaf);
    if (room.has_textures) hit.turns = model.edges[going.entry].turns;
    prefetch_look(going.entry);
    hit.way = room.ways.size();
    for (std::uint32_t i = 1; i <= going.frame; ++i)
        room.ways.push_back(room.frames[i].edge);
    room.ways.push_back(going.entry | (parent.cut ? from_cut : 0));
    hit.way_end = room.ways.size();
    return room.hits.size() - 1;
}

} // namespace graftal
