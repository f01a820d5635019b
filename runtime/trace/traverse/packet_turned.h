#pragma once

// Packets through models that turn or squeeze parts: every frame has the rays' directions there, and their
// reciprocals. In some frames rays go into boxes by different sides; then every lane sorts its own. What
// stands for sets without area is met alone, from the packet's frame on. Only packets.cpp includes
// this.

#include "compiler/primitives/texture_space.h"
#include "runtime/trace/traverse/packet_leaves.h"
#include "runtime/trace/traverse/places.h"
#include "runtime/trace/traverse/run_bodies.h"

namespace graftal {

template<Instructions instructions>
struct Traversal::TurnedPacket
    : PacketWalk<instructions, TurnedPacket<instructions>, Places, PacketRoom::Frame> {
    using Frame = PacketRoom::Frame;
    using Walk = PacketWalk<instructions, TurnedPacket, Places, Frame>;
    using typename Walk::Crossing;
    using typename Walk::Going;
    using typename Walk::Near;
    using typename Walk::Next;
    using Walk::best;
    using Walk::frames;
    using Walk::least;
    using Walk::lost;
    using Walk::model;
    using Walk::of;
    using Walk::room;
    using Walk::self;

    GRAFTAL_INLINE TurnedPacket(Traversal& traversal) : Walk(traversal, traversal.packet_->frames) {}

    // Functions that PacketWalk asks for:
    static GRAFTAL_INLINE std::size_t side_in(const Frame& frame, int axis) { return frame.side_in[axis]; }
    static GRAFTAL_INLINE bool is_mixed(const Frame& frame, int axis) { return frame.mixed[axis]; }
    static GRAFTAL_INLINE const Float8& reciprocal_of(const Frame& frame, int axis) {
        return frame.reciprocal[axis];
    }
    static GRAFTAL_INLINE const Float8& near_of(const Frame& frame, std::size_t side, int axis) {
        return frame.near[side][axis];
    }
    static GRAFTAL_INLINE float extreme_in(const Frame& frame, int axis) {
        return frame.side_in[axis] == 0 ? frame.extreme[1][axis] + margin_in(frame, axis)
                                        : frame.extreme[0][axis] - margin_in(frame, axis);
    }
    static GRAFTAL_INLINE float extreme_out(const Frame& frame, int axis) {
        return frame.side_in[axis] == 0 ? frame.extreme[0][axis] - margin_in(frame, axis)
                                        : frame.extreme[1][axis] + margin_in(frame, axis);
    }
    static GRAFTAL_INLINE Float8 least_reciprocal_of(const Frame& frame, int axis) {
        return spread<instructions>(frame.least_reciprocal[axis]);
    }
    static GRAFTAL_INLINE Float8 most_reciprocal_of(const Frame& frame, int axis) {
        return spread<instructions>(frame.most_reciprocal[axis]);
    }
    static GRAFTAL_INLINE float margin_in(const Frame& frame, int axis) {
        return static_cast<float>(frame.margin[axis]);
    }
    GRAFTAL_INLINE bool meets_together(const Going& going) const {
        const Frame& frame = frames[going.frame];
        if (model.clear_texels) return false;
        if (frame.items || LeafGroup::is(going.entry)) return frame.items || !frame.faint;
        return model.edges[going.entry].to_primitive && !frame.faint;
    }

    /// Kernel::try_edge() of the world, by rays that are parallel to no side.
    GRAFTAL_INLINE Next enter_world(Going& going) {
        Frame& frame = frames[0];
        this->spread_rays(frame.origin, frame.direction);
        static_cast<Place&>(frame) = Place();
        frame.steps = model.prepared.root_steps;
        frame.least_detail = model.least_detail_per_unit;
        frame.margin = Vec3(model.widest * model.most_half_width);
        const TraceEdge& edge = model.edges.front();
        if (edge.to_primitive) return Next::alone;
        const Box box = enlarged(edge.box, frame.margin);
        std::uint32_t parallel = 0, inside = 0;
        Double8 at;
        for (int i = 0; i < 2; ++i) {
            Double4 direction[3];
            for (int axis = 0; axis < 3; ++axis)
                direction[axis] = frame.direction[axis].half[i];
            frame.speed.half[i] = power_below(largest_of(direction[0], direction[1], direction[2]));
            frame.unit.half[i] = inverse_power(frame.speed.half[i]);
            frame.base.half[i] = Double4{};
            Double4 from = least.half[i] * frame.speed.half[i], to = best.half[i] * frame.speed.half[i];
            for (int axis = 0; axis < 3; ++axis) {
                const Double4 d = direction[axis] * frame.unit.half[i];
                frame.direction[axis].half[i] = d;
                parallel |= bits_of<instructions>(d == 0);
                const Double4 over = 1 / d;
                const Double4 a = (splat(box.min[axis]) - frame.origin[axis].half[i]) * over,
                              b = (splat(box.max[axis]) - frame.origin[axis].half[i]) * over;
                const Double4 in = b < a ? b : a, out = a < b ? b : a;
                from = from < in ? in : from;
                to = out < to ? out : to;
            }
            inside |= bits_of<instructions>(from <= to) << (4 * i);
            at.half[i] = from;
        }
        if (parallel != 0) return Next::alone;
        ready_directions(frame, 0xff);
        going.mask &= inside;
        return going.mask != 0 ? enter(going, at) : Next::end;
    }

    GRAFTAL_INLINE Next enter(Going& going) {
        return enter(going, {doubles_of(going.at, 0), doubles_of(going.at, 1)});
    }

    GRAFTAL_INLINE Next enter(Going& going, const Double8& at) {
        Frame& frame = this->frame_after(going.frame); // parents may move, but no more after this
        const Frame& parent = frames[going.frame];
        if (parent.items) {
            if (model.clear_texels) return Next::alone;
            meet_item(going, at);
            return Next::end;
        }
        const TraceEdge& edge = model.edges[going.entry];
        const TraceNode& node = model.nodes[edge.child];
        if (parent.specks && node.speck_count > 0) return Next::alone;
        if (edge.to_primitive && (parent.faint || model.clear_texels)) return Next::alone;
        frame.flatness = parent.flatness;
        if (!edge.similarity) {
            self.more_work_ += RayWork::stretched * static_cast<std::uint64_t>(std::popcount(going.mask));
            frame.flatness *= edge.flatness;
            if (!(frame.flatness > flattest_placement)) {
                lost |= going.mask;
                return Next::end;
            }
        }
        if (edge.to_primitive) {
            meet_leaf(edge, node, going, at);
            return Next::end;
        }
        if (!this->go_to_child(edge, node, going.entry, parent, frame)) return Next::end;
        const bool is_proxy = frame.cut && node.stop_tree == no_tree;
        if (is_proxy && (frame.faint || node.faint)) return Next::alone;
        if (frame.cut && frame.faint && node.speck_count > 0 && frame.flatness == 1) return Next::alone;
        this->count(going);
        Near near[2];
        for (int i = 0; i < 2; ++i) {
            take_rays(edge, parent, at.half[i], i, near[i]);
            if (!edge.similarity) going.mask &= ~((~bits_of<instructions>(near[i].is_map) & 15) << (4 * i));
        }
        if (going.mask == 0) return Next::end;
        if (is_proxy) {
            meet_proxy(node, frame, going, near);
            return Next::end;
        }
        for (int i = 0; i < 2; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                frame.origin[axis].half[i] = near[i].origin[axis];
                frame.direction[axis].half[i] = near[i].along[axis];
            }
            frame.base.half[i] = near[i].base;
            frame.unit.half[i] = near[i].unit;
            frame.speed.half[i] = near[i].speed;
        }
        frame.margin = this->margin_of(node, frame);
        if (edge.upright)
            keep_directions(parent, frame);
        else
            ready_directions(frame, going.mask);
        Float8 origin[3];
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis] = floats_of(frame.origin[axis]);
            frame.near[0][axis] = origin[axis] + spread<instructions>(margin_in(frame, axis));
            frame.near[1][axis] = origin[axis] - spread<instructions>(margin_in(frame, axis));
        }
        this->ready_rays(frame, origin, going.mask);
        return this->go_in(node, frame.cut, frame.cut ? node.stop_tree : this->tree_of(node, frame), going);
    }

    /// Kernel::take_ray() for four rays.
    GRAFTAL_INLINE void take_rays(const TraceEdge& edge, const Frame& parent, const Double4& at, int half,
                                  Near& near) const {
        Double4 from[3], direction[3];
        for (int axis = 0; axis < 3; ++axis) {
            direction[axis] = parent.direction[axis].half[half];
            from[axis] = parent.origin[axis].half[half] + at * direction[axis];
        }
        near.base = parent.base.half[half] + at * parent.unit.half[half];
        Double4 growth = splat(edge.growth), stretch = splat(edge.stretch);
        const LaneMap& map = edge.child_from_parent;
        near.is_map = growth == growth;
        if (edge.upright) {
            for (int axis = 0; axis < 3; ++axis) {
                near.origin[axis] = from[axis] * splat(map.column[0][0]) + splat(map.translation[axis]);
                near.along[axis] = direction[axis];
            }
        } else {
            for (int axis = 0; axis < 3; ++axis) {
                near.origin[axis] =
                    through(map, from[0], from[1], from[2], axis) + splat(map.translation[axis]);
                near.along[axis] = through(map, direction[0], direction[1], direction[2], axis);
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
    }

    static GRAFTAL_INLINE void keep_directions(const Frame& parent, Frame& frame) {
        for (int axis = 0; axis < 3; ++axis) {
            frame.reciprocal[axis] = parent.reciprocal[axis];
            frame.least_reciprocal[axis] = parent.least_reciprocal[axis];
            frame.most_reciprocal[axis] = parent.most_reciprocal[axis];
            frame.side_in[axis] = parent.side_in[axis];
            frame.mixed[axis] = parent.mixed[axis];
        }
    }

    static GRAFTAL_INLINE void ready_directions(Frame& frame, std::uint32_t mask) {
        for (int axis = 0; axis < 3; ++axis) {
            const Float8 d = floats_of(frame.direction[axis]), tiny = spread<instructions>(1e-18f);
            const Float8 over = 1 / ((d < 0 ? -d : d) > tiny ? d : tiny);
            const std::uint32_t negative = bits_of<instructions>(over < 0) & mask;
            frame.reciprocal[axis] = over;
            frame.least_reciprocal[axis] = smallest<instructions>(over, mask);
            frame.most_reciprocal[axis] = greatest<instructions>(over, mask);
            frame.mixed[axis] = negative != 0 && negative != mask;
            frame.side_in[axis] = negative == mask ? 1 : 0;
        }
    }

    /// Meets the stand-in of the frame's node, which is the next after that where the rays were.
    GRAFTAL_INLINE void meet_proxy(const TraceNode& node, const Frame& frame, const Going& going,
                                   Near (&near)[2]) {
        if (!Walk::meet_proxy(node, near, going.mask)) return;
        PacketRoom::Hit& hit = room.hits.back();
        hit.proxy_node = frame.node;
        compose(frame.world_from_node, node.node_from_proxy, hit.world_from_leaf);
        Walk::keep_way(going.frame + 1, hit);
        hit.way_end = room.ways.size();
    }

    GRAFTAL_INLINE void meet_leaf(const TraceEdge& edge, const TraceNode& node, const Going& going,
                                  const Double8& at) {
        this->count(going);
        const Frame& parent = frames[going.frame];
        const bool cube = node.primitive == PrimitiveKind::cube,
                   triangle = node.primitive == PrimitiveKind::triangle;
        Near near[2];
        Crossing crossing[2];
        for (int i = 0; i < 2; ++i) {
            take_rays(edge, parent, at.half[i], i, near[i]);
            this->ready_range(near[i], i);
            if (!cube && !triangle) {
                crossing[i] = this->cross_any(node.primitive, near[i], i, going.mask);
                crossing[i].in_world = near[i].base + crossing[i].t * near[i].unit;
                continue;
            }
            // Rays that intersect() calls insane, and those that are parallel to a side.
            Long4 odd = largest_of(near[i].origin[0], near[i].origin[1], near[i].origin[2]) > splat(1e11);
            if (cube) {
                Double4 over[3];
                for (int axis = 0; axis < 3; ++axis) {
                    odd = odd | (size_of(near[i].along[axis]) < splat(parallel_to_plane));
                    over[axis] = 1 / near[i].along[axis];
                }
                crossing[i] = Walk::cross_cube(near[i], over);
            } else {
                crossing[i] = Walk::cross_triangle(near[i]);
            }
            crossing[i].in_world = near[i].base + crossing[i].t * near[i].unit;
            lost |= bits_of<instructions>(odd) << (4 * i) & going.mask;
        }
        if (!this->keep_crossings(near, crossing, going.mask)) return;
        PacketRoom::Hit& hit = room.hits.back();
        compose(parent.world_from_node, edge.parent_from_child, hit.world_from_leaf);
        hit.turns = edge.turns;
        keep_way(going, going.entry | (parent.cut ? from_cut : 0), hit);
    }

    GRAFTAL_INLINE void keep_way(const Going& going, std::uint32_t last, PacketRoom::Hit& hit) const {
        Walk::keep_way(going.frame, hit);
        room.ways.push_back(last);
        hit.way_end = room.ways.size();
    }

    /// Kernel::meet_item() for a packet.
    GRAFTAL_INLINE void meet_item(const Going& going, const Double8& at) {
        this->count(going);
        const Frame& frame = frames[going.frame];
        const TraceRun& run = model.runs[model.nodes[frame.node].run];
        const RunItem& item = (*run.run)[going.entry];
        const Affine& run_from_frame = model.graph_from_frame[frame.node];
        Double4 from[2][3]; // the item's base
        std::uint32_t by_body = going.mask, by_ball = item.ball ? going.mask : 0;
        for (int i = 0; i < 2; ++i) {
            Double4 direction[3];
            for (int axis = 0; axis < 3; ++axis) {
                direction[axis] = frame.direction[axis].half[i];
                from[i][axis] = (frame.origin[axis].half[i] + at.half[i] * direction[axis]) *
                                    splat(run_from_frame.linear[axis][axis]) +
                                splat(run_from_frame.translation[axis] - item.base[axis]);
            }
            if (!item.shape.is_sphere()) by_body &= ~(passing_line(direction, from[i], item) << (4 * i));
            if (item.ball) by_ball &= ~(passing_ball(direction, from[i], item) << (4 * i));
        }
        if (by_body != 0)
            meet_body(item.shape, run.pictured ? run_from_body(item) : run_from_round_body(item), run, item,
                      going, at, by_body);
        if (by_ball != 0)
            meet_body(PrimitiveKind::sphere, run.pictured ? run_from_ball(item) : run_from_round_ball(item),
                      run, item, going, at, by_ball);
    }

    using Vector4 = Double4[3];
    static GRAFTAL_INLINE Double4 dot(const Vector4& a, const Vector4& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static GRAFTAL_INLINE void cross(const Vector4& a, const Vector4& b, Vector4& product) {
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            product[axis] = a[next] * b[last] - a[last] * b[next];
        }
    }
    /// passes_line() and passes_point(), for an item's axis and its ball.
    static GRAFTAL_INLINE std::uint32_t passing_line(const Vector4& direction, const Vector4& from,
                                                     const RunItem& item) {
        const Vector4 axis = {splat(item.axis.x), splat(item.axis.y), splat(item.axis.z)};
        Vector4 upright;
        cross(direction, axis, upright);
        const Double4 apart = dot(from, upright);
        return bits_of<instructions>(apart * apart > splat(surely_beside * item.radius * item.radius) *
                                                         dot(upright, upright));
    }
    static GRAFTAL_INLINE std::uint32_t passing_ball(const Vector4& direction, const Vector4& from,
                                                     const RunItem& item) {
        const Vector4 from_ball = {from[0] - splat(item.axis.x), from[1] - splat(item.axis.y),
                                   from[2] - splat(item.axis.z)};
        Vector4 moment;
        cross(direction, from_ball, moment);
        return bits_of<instructions>(dot(moment, moment) > splat(surely_beside * item.radius * item.radius) *
                                                               dot(direction, direction));
    }

    /// Kernel::meet_body() for a packet.
    GRAFTAL_INLINE void meet_body(RunShape shape, const Affine& run_from_body, const TraceRun& run,
                                  const RunItem& item, const Going& going, const Double8& at,
                                  std::uint32_t mask) {
        const Frame& frame = frames[going.frame];
        const Affine& run_from_frame = model.graph_from_frame[frame.node];
        const Primitive primitive = shape.primitive();
        Near near[2];
        Crossing crossing[2];
        for (int i = 0; i < 2; ++i) {
            near[i].base = frame.base.half[i] + at.half[i] * frame.unit.half[i];
            near[i].speed = frame.speed.half[i];
            near[i].is_map = Long4{};
            for (std::uint32_t left = mask >> (4 * i) & 15; left != 0; left &= left - 1) {
                const int j = std::countr_zero(left);
                Vec3 origin, direction;
                for (int axis = 0; axis < 3; ++axis) {
                    direction[axis] = frame.direction[axis].half[i][j];
                    origin[axis] = frame.origin[axis].half[i][j] + at.half[i][j] * direction[axis];
                }
                Ray inner;
                double largest;
                if (!take_into_body(run_from_body,
                                    {run_from_frame(origin), run_from_frame.linear * direction}, inner,
                                    largest))
                    continue;
                near[i].is_map[j] = -1;
                near[i].speed[j] = frame.speed.half[i][j] * largest;
                for (int axis = 0; axis < 3; ++axis) {
                    near[i].origin[axis][j] = inner.origin[axis];
                    near[i].along[axis][j] = inner.direction[axis];
                }
            }
            this->ready_range(near[i], i);
            crossing[i] = this->cross_any(primitive, near[i], i, mask);
            crossing[i].in_world = near[i].base + crossing[i].t / near[i].speed;
        }
        if (!this->keep_crossings(near, crossing, mask)) return;
        PacketRoom::Hit& hit = room.hits.back();
        compose(frame.world_from_node, LaneMap(inverse(model.graph_from_frame[frame.node]) * run_from_body),
                hit.world_from_leaf);
        hit.turns = length_in_turns(run_from_body.linear);
        keep_way(going, run.edge_of(shape, item.colour), hit);
    }

    GRAFTAL_INLINE bool resume(const Going& going, int lane, const RayRange& range) const {
        while (self.frames_.size() <= going.frame)
            self.frames_.resize(2 * self.frames_.size());
        const Frame& from = frames[going.frame];
        Traversal::Frame& frame = self.frames_[going.frame];
        static_cast<Place&>(frame) = from;
        for (int axis = 0; axis < 3; ++axis) {
            frame.origin[axis] = of(from.origin[axis], lane);
            frame.direction[axis] = of(from.direction[axis], lane);
            frame.reciprocal[axis] = from.reciprocal[axis][lane];
        }
        frame.origin[3] = frame.direction[3] = 0;
        frame.reciprocal[3] = 1e18f;
        frame.base = of(from.base, lane);
        frame.unit = of(from.unit, lane);
        frame.speed = of(from.speed, lane);
        frame.least = from.least[lane];
        frame.side_in = -(frame.reciprocal < 0);
        for (int axis = 0; axis < 3; ++axis) {
            const bool upper = frame.side_in[axis] != 0;
            frame.origin_in[axis] = from.near[upper][axis][lane];
            frame.origin_out[axis] = from.near[!upper][axis][lane];
        }
        for (std::uint32_t above = 1; above < going.frame; ++above)
            self.frames_[above].edge = frames[above].edge;
        return self.resume({going.at[lane], going.entry, going.frame}, range);
    }
};

} // namespace graftal
