#pragma once

// Packets through even models: the rays keep their directions in all frames. Only packets.cpp
// includes this.

#include "runtime/trace/traverse/even.h"
#include "runtime/trace/traverse/packet_leaves.h"

namespace graftal {

template<Instructions instructions>
struct Traversal::EvenPacket
    : PacketWalk<instructions, EvenPacket<instructions>, EvenPlaces, PacketRoom::EvenFrame> {
    using Frame = PacketRoom::EvenFrame;
    using Walk = PacketWalk<instructions, EvenPacket, EvenPlaces, Frame>;
    using typename Walk::Crossing;
    using typename Walk::Going;
    using typename Walk::Near;
    using typename Walk::Next;
    using Walk::best;
    using Walk::frames;
    using Walk::least;
    using Walk::model;
    using Walk::of;
    using Walk::room;
    using Walk::self;

    // In every frame:
    Double8 direction[3], inverse[3];
    Float8 reciprocal[3];
    Float8 least_reciprocal[3], most_reciprocal[3]; ///< of all rays
    std::size_t sides[3];                           ///< of boxes, where rays go in

    GRAFTAL_INLINE EvenPacket(Traversal& traversal) : Walk(traversal, traversal.packet_->even_frames) {}

    // Functions that PacketWalk asks for:
    GRAFTAL_INLINE std::size_t side_in(const Frame&, int axis) const { return sides[axis]; }
    static GRAFTAL_INLINE bool is_mixed(const Frame&, int) { return false; }
    GRAFTAL_INLINE const Float8& reciprocal_of(const Frame&, int axis) const { return reciprocal[axis]; }
    static GRAFTAL_INLINE const Float8& near_of(const Frame& frame, std::size_t, int axis) {
        return frame.near[axis];
    }
    GRAFTAL_INLINE float extreme_in(const Frame& frame, int axis) const {
        return frame.extreme[1 - sides[axis]][axis];
    }
    GRAFTAL_INLINE float extreme_out(const Frame& frame, int axis) const {
        return frame.extreme[sides[axis]][axis];
    }
    GRAFTAL_INLINE const Float8& least_reciprocal_of(const Frame&, int axis) const {
        return least_reciprocal[axis];
    }
    GRAFTAL_INLINE const Float8& most_reciprocal_of(const Frame&, int axis) const {
        return most_reciprocal[axis];
    }
    GRAFTAL_INLINE bool meets_together(const Going& going) const {
        return LeafGroup::is(going.entry) || model.even_parts[going.entry].kind != EvenPart::Kind::node;
    }

    /// Brings all rays to the box of the model. They are to go alone if they do not go to the same sides of
    /// boxes, or along some.
    GRAFTAL_INLINE Next enter_world(Going& going) {
        Frame& frame = frames[0];
        Double8 origin[3];
        this->spread_rays(origin, direction);
        const Box box = enlarged(model.edges.front().box, Vec3(0.0));
        std::uint32_t parallel = 0, inside = 0;
        for (int i = 0; i < 2; ++i) {
            const Double4 speed =
                power_below(largest_of(direction[0].half[i], direction[1].half[i], direction[2].half[i]));
            const Double4 unit = inverse_power(speed);
            Double4 from = least.half[i] * speed, to = best.half[i] * speed;
            for (int axis = 0; axis < 3; ++axis) {
                direction[axis].half[i] = direction[axis].half[i] * unit;
                const Double4 d = direction[axis].half[i];
                const Double4 over = 1 / d;
                inverse[axis].half[i] = over;
                parallel |= bits_of<instructions>(size_of(d) < splat(parallel_to_plane));
                const Double4 a = (splat(box.min[axis]) - origin[axis].half[i]) * over,
                              b = (splat(box.max[axis]) - origin[axis].half[i]) * over;
                const Double4 in = b < a ? b : a, out = a < b ? b : a;
                from = from < in ? in : from;
                to = out < to ? out : to;
            }
            inside |= bits_of<instructions>(from <= to) << (4 * i);
            for (int axis = 0; axis < 3; ++axis)
                frame.origin[axis].half[i] = origin[axis].half[i] + from * direction[axis].half[i];
            frame.base.half[i] = from * unit;
            frame.unit.half[i] = unit;
            frame.speed.half[i] = speed;
        }
        if (parallel != 0) return Next::alone;
        for (int axis = 0; axis < 3; ++axis) {
            const Float8 d = floats_of(direction[axis]), tiny = spread<instructions>(1e-18f);
            reciprocal[axis] = 1 / ((d < 0 ? -d : d) > tiny ? d : tiny);
            const std::uint32_t negative = bits_of<instructions>(reciprocal[axis] < 0);
            if (negative != 0 && negative != 0xff) return Next::alone;
            sides[axis] = negative != 0 ? 1 : 0;
            least_reciprocal[axis] = spread<instructions>(smallest<instructions>(reciprocal[axis], 0xff));
            most_reciprocal[axis] = spread<instructions>(greatest<instructions>(reciprocal[axis], 0xff));
        }
        frame.hits_then = UINT32_MAX;
        this->place_world(frame);
        going.mask &= inside;
        return going.mask != 0 ? Next::on : Next::end;
    }

    GRAFTAL_INLINE Next enter(Going& going) {
        const EvenPart& part = model.even_parts[going.entry];
        if (part.kind != EvenPart::Kind::node) {
            meet_leaf(part, going);
            return Next::end;
        }
        Frame& frame = this->frame_after(going.frame); // parents may move, but no more after this
        const Frame& parent = frames[going.frame];
        if (!this->go_to_child(part, going.entry, parent, frame)) return Next::end;
        const TraceNode& node = model.nodes[part.child];
        const bool is_proxy = frame.cut && node.stop_tree == no_tree;
        if (is_proxy && node.faint) return Next::alone;
        this->count(going);
        for (int i = 0; i < 2; ++i) {
            const Double4 at = doubles_of(going.at, i);
            for (int axis = 0; axis < 3; ++axis)
                frame.origin[axis].half[i] =
                    (parent.origin[axis].half[i] + at * direction[axis].half[i]) * splat(part.shrink()) +
                    splat(part.shift[axis]);
            frame.base.half[i] = parent.base.half[i] + at * parent.unit.half[i];
            frame.unit.half[i] = parent.unit.half[i] * part.stretch;
            frame.speed.half[i] = parent.speed.half[i] * part.growth;
        }
        if (is_proxy) {
            meet_proxy(node, frame, going);
            return Next::end;
        }
        for (int axis = 0; axis < 3; ++axis)
            frame.near[axis] = floats_of(frame.origin[axis]);
        this->ready_rays(frame, frame.near, going.mask);
        return this->go_in(node, frame.cut,
                           frame.cut ? node.stop_tree : this->tree_of(node, frame, part, parent), going);
    }

    /// Meets the stand-in of the frame's node, which is the next after that where the rays are.
    GRAFTAL_INLINE void meet_proxy(const TraceNode& node, const Frame& frame, const Going& going) {
        Near near[2];
        for (int i = 0; i < 2; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                near[i].origin[axis] = frame.origin[axis].half[i];
                near[i].along[axis] = direction[axis].half[i];
            }
            near[i].base = frame.base.half[i];
            near[i].unit = frame.unit.half[i];
            near[i].speed = frame.speed.half[i];
            near[i].is_map = near[i].base == near[i].base;
        }
        if (!Walk::meet_proxy(node, near, going.mask)) return;
        PacketRoom::Hit& hit = room.hits.back();
        hit.proxy_node = frame.node;
        this->place(frame, node.node_from_proxy, hit.world_from_leaf);
        this->keep_way(going.frame + 1, hit);
        hit.way_end = room.ways.size();
    }

    GRAFTAL_INLINE void meet_leaf(const EvenPart& part, const Going& going) {
        this->count(going);
        const TraceEdge& edge = model.edges[going.entry];
        Near near[2];
        Crossing crossing[2];
        for (int i = 0; i < 2; ++i) {
            near[i] = bring_near(part, edge, going, i);
            const Double4 over[3] = {inverse[0].half[i], inverse[1].half[i], inverse[2].half[i]};
            crossing[i] = part.kind == EvenPart::Kind::cube ? Walk::cross_cube(near[i], over)
                          : part.kind == EvenPart::Kind::triangle
                              ? Walk::cross_triangle(near[i])
                              : this->cross_any(model.nodes[part.child].primitive, near[i], i, going.mask);
            crossing[i].in_world = near[i].base + crossing[i].t * near[i].unit;
        }
        if (!this->keep_crossings(near, crossing, going.mask)) return;
        PacketRoom::Hit& hit = room.hits.back();
        const Frame& parent = frames[going.frame];
        hit.is_upright = part.upright && !room.has_patterns;
        if (!hit.is_upright) this->place(parent, edge.parent_from_child, hit.world_from_leaf);
        if (room.has_textures) hit.turns = edge.turns;
        this->prefetch_look(going.entry);
        this->keep_way(going.frame, hit);
        room.ways.push_back(going.entry | (parent.cut ? from_cut : 0));
        hit.way_end = room.ways.size();
    }

    /// Four rays of those on their way into a leaf.
    GRAFTAL_INLINE Near bring_near(const EvenPart& part, const TraceEdge& edge, const Going& going,
                                   int half) const {
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
                near.origin[axis] =
                    through(map, from[0], from[1], from[2], axis) + splat(map.translation[axis]);
                near.along[axis] = through(map, direction[0].half[half], direction[1].half[half],
                                           direction[2].half[half], axis);
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
        this->ready_range(near, half);
        return near;
    }

    GRAFTAL_INLINE bool resume(const Going& going, int lane, const RayRange& range) const {
        EvenKernel<instructions, false> alone(self, model, range);
        while (self.even_frames_.size() <= going.frame)
            self.even_frames_.resize(2 * self.even_frames_.size());
        alone.frames = self.even_frames_.data();
        const Frame& parent = frames[going.frame];
        EvenFrame& frame = alone.frames[going.frame];
        static_cast<EvenPlace&>(frame) = parent;
        frame.origin =
            Double4{of(parent.origin[0], lane), of(parent.origin[1], lane), of(parent.origin[2], lane), 0};
        frame.base = of(parent.base, lane);
        frame.unit = of(parent.unit, lane);
        frame.speed = of(parent.speed, lane);
        frame.near = __builtin_convertvector(frame.origin, Float4);
        frame.least = parent.least[lane];
        for (std::uint32_t above = 1; above < going.frame; ++above)
            alone.frames[above].edge = frames[above].edge;
        alone.direction = Double4{of(direction[0], lane), of(direction[1], lane), of(direction[2], lane), 0};
        alone.inverse = Double4{of(inverse[0], lane), of(inverse[1], lane), of(inverse[2], lane), 0};
        alone.is_parallel = false;
        for (int axis = 0; axis < 3; ++axis)
            alone.reciprocal[axis] = spread<instructions>(reciprocal[axis][lane]);
        alone.set_sides(sides);
        alone.first_placed = going.frame;
        return alone.go_on({going.at[lane], going.entry, going.frame});
    }
};

} // namespace graftal
