#pragma once

// Eight rays at once through even models: neighbours of a picture mostly look into the same parts. Each ray is
// taken into frames and meets leaves by the very operations of the way alone (traversal_even.h), in a lane of
// its own. What differs is the order in which parts are looked into. That matters only where two hits are all
// but equally near: such a ray goes again, alone. So a packet gives what its rays give one by one, to the last
// bit. Only traversal.cpp includes this.

#include "runtime/trace/packet_room.h"
#include "runtime/trace/traversal_even.h"

namespace graftal {

template<Instructions instructions> struct Traversal::EvenPacket : EvenPlaces {
    using Frame = PacketRoom::Frame;
    using Entry = PacketRoom::Entry;
    using Alone = EvenKernel<instructions, false>;

    /// Rays on their way into an entry.
    struct Going {
        Float8 at;     ///< from where on, in units from each ray's base
        float key = 0; ///< as Entry's
        std::uint32_t entry, frame, mask, box;
    };

    PacketRoom& room;
    // In every frame:
    Double8 direction[3], inverse[3];
    Float8 reciprocal[3];
    Float8 least_reciprocal[3], most_reciprocal[3]; ///< of all rays
    std::size_t side_in[3];

    Double8 best;            ///< of t
    std::uint32_t found = 0; ///< rays that have met something
    std::uint32_t tied = 0;  ///< and something else about as near
    std::uint64_t visits = 0;

    GRAFTAL_INLINE EvenPacket(Traversal& traversal, const TraceModel& traced, const RayRange& asked)
        : EvenPlaces{traversal, traced, asked}, room(*traversal.packet_) {}

    /// Fills in the room's hits; rays that are to go alone are in `tied`.
    GRAFTAL_INLINE void run(std::span<const Ray> rays) {
        self.hurries_ = false;
        room.clear();
        best = {splat(range.most), splat(range.most)};
        const std::uint32_t all = (1u << rays.size()) - 1;
        std::uint32_t inside = 0;
        if (!enter_world(rays, inside)) {
            tied = all;
            return;
        }
        inside &= all;
        if (inside == 0) return;
        Going going{Float8{}, 0, 0, 0, inside, Entry::no_box};
        for (bool more = true; more || pop(going);) {
            const Next next = is_left_alone(going) ? Next::alone : go_together(going);
            more = next == Next::on;
            if (next == Next::alone)
                for (std::uint32_t left = going.mask; left != 0; left &= left - 1)
                    go_alone(going, std::countr_zero(left));
            if (visits > most_visits) {
                tied = all;
                return;
            }
        }
    }

    /// What becomes of rays that go into something: they are at its end, on their way into the nearest of what
    /// is in it, or each is to go there by itself.
    enum class Next { end, on, alone };

    /// Takes the nearest entry, if one is left that is nearer than what its rays have met.
    GRAFTAL_INLINE bool pop(Going& going) {
        while (room.top > 0) {
            const Entry& entry = room.entries[--room.top];
            going.entry = entry.entry;
            going.frame = entry.frame;
            going.mask = entry.mask;
            going.at = at_box(entry);
            if (leave_out_beaten(going)) return true;
        }
        return false;
    }

    /// So many rays go alone: fewer than that have little in common.
    static constexpr int few = 2;
    /// A packet that went into so many parts is left to its rays, which may be given up.
    static constexpr std::uint64_t most_visits = 1 << 13;

    /// Brings all rays to the box of the model; `inside`: those that meet it. False if they do not go to the
    /// same sides of boxes, or along some.
    GRAFTAL_INLINE bool enter_world(std::span<const Ray> rays, std::uint32_t& inside) {
        Frame& frame = room.frames[0];
        Double8 origin[3];
        for (std::size_t lane = 0; lane < 8; ++lane) {
            const Ray& ray = rays[std::min(lane, rays.size() - 1)];
            for (int axis = 0; axis < 3; ++axis) {
                origin[axis].half[lane / 4][lane % 4] = ray.origin[axis];
                direction[axis].half[lane / 4][lane % 4] = ray.direction[axis];
            }
        }
        const Box box = enlarged(model.edges.front().box, Vec3(0.0));
        std::uint32_t parallel = 0;
        for (int i = 0; i < 2; ++i) {
            const auto size = [](const Double4& x) GRAFTAL_INLINED_LAMBDA { return x < 0 ? -x : x; };
            const Double4 x = size(direction[0].half[i]), y = size(direction[1].half[i]),
                          z = size(direction[2].half[i]);
            const Double4 xy = x < y ? y : x;
            const Double4 speed = xy < z ? z : xy, unit = 1 / speed;
            Double4 least = range.least * speed, most = best.half[i] * speed;
            for (int axis = 0; axis < 3; ++axis) {
                direction[axis].half[i] = direction[axis].half[i] * unit;
                const Double4 d = direction[axis].half[i];
                const Double4 over = 1 / d;
                inverse[axis].half[i] = over;
                parallel |= bits_of<instructions>(size(d) < splat(parallel_to_plane));
                const Double4 a = (splat(box.min[axis]) - origin[axis].half[i]) * over,
                              b = (splat(box.max[axis]) - origin[axis].half[i]) * over;
                const Double4 in = b < a ? b : a, out = a < b ? b : a;
                least = least < in ? in : least;
                most = out < most ? out : most;
            }
            inside |= bits_of<instructions>(least <= most) << (4 * i);
            for (int axis = 0; axis < 3; ++axis)
                frame.origin[axis].half[i] = origin[axis].half[i] + least * direction[axis].half[i];
            frame.base.half[i] = least * unit;
            frame.unit.half[i] = unit;
            frame.speed.half[i] = speed;
        }
        if (parallel != 0) return false;
        for (int axis = 0; axis < 3; ++axis) {
            const Float8 d = floats_of(direction[axis]), least = spread<instructions>(1e-18f);
            reciprocal[axis] = 1 / ((d < 0 ? -d : d) > least ? d : least);
            const std::uint32_t negative = bits_of<instructions>(reciprocal[axis] < 0);
            if (negative != 0 && negative != 0xff) return false;
            side_in[axis] = negative != 0 ? 1 : 0;
            least_reciprocal[axis] = spread<instructions>(smallest(reciprocal[axis], 0xff));
            most_reciprocal[axis] = spread<instructions>(greatest(reciprocal[axis], 0xff));
        }
        frame.hits_then = UINT32_MAX;
        frame.offset = Double4{};
        frame.entry = frame.scale = 1;
        frame.steps = model.prepared.root_steps;
        frame.cut = false;
        frame.least_detail = model.least_detail_per_unit;
        return true;
    }

    /// Of rays that have met something, in the frame, as single precision tells; a little more.
    GRAFTAL_INLINE const Float8& most_in(Frame& frame) const {
        const auto hits = static_cast<std::uint32_t>(room.hits.size());
        if (frame.hits_then == hits) return frame.most;
        Double8 most;
        for (int i = 0; i < 2; ++i)
            most.half[i] = (best.half[i] - frame.base.half[i]) * frame.speed.half[i];
        frame.hits_then = hits;
        return frame.most = floats_of(most) + 2e-6f;
    }

    GRAFTAL_INLINE Float8 at_box(const Entry& entry) const {
        if (entry.box == Entry::no_box) return Float8{};
        const BoxNode& node = model.boxes[entry.box / 8];
        const Frame& frame = room.frames[entry.frame];
        Float8 enters = frame.least;
        for (int axis = 0; axis < 3; ++axis)
            enters = greater(
                enters, (spread<instructions>(side_of(node, side_in[axis], axis)[entry.box % 8]) - frame.near[axis]) *
                            reciprocal[axis]);
        return enters;
    }

    /// False if all rays have met something nearer than the entry is.
    GRAFTAL_INLINE bool leave_out_beaten(Going& entry) const {
        if ((entry.mask & found) == 0) return true;
        entry.mask &= bits_of<instructions>(entry.at <= most_in(room.frames[entry.frame]));
        return entry.mask != 0;
    }

    /// Puts the nearest of the boxes that rays meet in the place of their node, and the others onto the stack, the
    /// farthest first.
    GRAFTAL_INLINE Next test_boxes(Going& going) {
        const std::uint32_t number = going.entry & ~BoxNode::inner, frame_number = going.frame, mask = going.mask;
        const BoxNode& node = model.boxes[number];
        Frame& frame = room.frames[frame_number];
        const Float8 least = frame.least, most = most_in(frame);
        const Float8 near[3] = {frame.near[0], frame.near[1], frame.near[2]};
        const float* const in[3] = {side_of(node, side_in[0], 0), side_of(node, side_in[1], 1),
                                    side_of(node, side_in[2], 2)};
        const float* const out[3] = {side_of(node, 1 - side_in[0], 0), side_of(node, 1 - side_in[1], 1),
                                     side_of(node, 1 - side_in[2], 2)};
        const int lead = std::countr_zero(mask);
        Entry* const first = room.reserve(8);
        Entry* end = first;
        bool none = true;
        for (std::uint32_t left = boxes_near(node, frame, most, mask); left != 0; left &= left - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(left));
            Float8 enters = least, leaves = most;
            for (int axis = 0; axis < 3; ++axis) {
                enters = greater(enters,
                                 (spread<instructions>(in[axis][child]) - near[axis]) * reciprocal[axis]);
                leaves = lesser(leaves,
                                (spread<instructions>(out[axis][child]) - near[axis]) * reciprocal[axis]);
            }
            const std::uint32_t meeting = bits_of<instructions>(enters <= leaves) & mask;
            if (meeting == 0) continue;
            float key = enters[meeting >> lead & 1 ? lead : std::countr_zero(meeting)];
            std::uint32_t into = node.entry[child], rays = meeting,
                          box = 8 * number + static_cast<std::uint32_t>(child);
            if (key <= going.key || none) {
                std::swap(key, going.key);
                std::swap(into, going.entry);
                std::swap(rays, going.mask);
                std::swap(box, going.box);
                going.at = enters;
                if (std::exchange(none, false)) continue;
            }
            Entry* place = end++;
            for (; place > first && place[-1].key < key; --place)
                *place = place[-1];
            place->key = key;
            place->entry = into;
            place->frame = frame_number;
            place->mask = rays;
            place->box = box;
        }
        room.top += static_cast<std::size_t>(end - first);
        return none ? Next::end : Next::on;
    }

    /// Which of eight boxes a ray of the packet may meet, as the extremes of all rays tell. Sums and products are
    /// rounded in order, so that none is left out.
    GRAFTAL_INLINE std::uint32_t boxes_near(const BoxNode& node, const Frame& frame, const Float8& most,
                                            std::uint32_t mask) const {
        Float8 enters = spread<instructions>(frame.first_least);
        Float8 leaves = spread<instructions>(greatest(most, mask));
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t in = side_in[axis];
            const Float8 from = node.side[in][axis] - spread<instructions>(frame.extreme[1 - in][axis]),
                         to = node.side[1 - in][axis] - spread<instructions>(frame.extreme[in][axis]);
            enters = greater(enters, lesser(from * least_reciprocal[axis], from * most_reciprocal[axis]));
            leaves = lesser(leaves, greater(to * least_reciprocal[axis], to * most_reciprocal[axis]));
        }
        return bits_of<instructions>(enters <= leaves);
    }

    static GRAFTAL_INLINE Float8 lanes_in(const Float8& lanes, std::uint32_t mask, float other) {
        constexpr Int8 bit = {1, 2, 4, 8, 16, 32, 64, 128};
        const Int8 used = (static_cast<std::int32_t>(mask) & bit) != 0;
        return used ? lanes : spread<instructions>(other);
    }

    static GRAFTAL_INLINE float greatest(const Float8& lanes, std::uint32_t mask) {
        Float8 all = lanes_in(lanes, mask, -INFINITY);
        all = greater(all, __builtin_shufflevector(all, all, 4, 5, 6, 7, 0, 1, 2, 3));
        all = greater(all, __builtin_shufflevector(all, all, 2, 3, 0, 1, 6, 7, 4, 5));
        all = greater(all, __builtin_shufflevector(all, all, 1, 0, 3, 2, 5, 4, 7, 6));
        return all[0];
    }

    static GRAFTAL_INLINE float smallest(const Float8& lanes, std::uint32_t mask) {
        Float8 all = lanes_in(lanes, mask, INFINITY);
        all = lesser(all, __builtin_shufflevector(all, all, 4, 5, 6, 7, 0, 1, 2, 3));
        all = lesser(all, __builtin_shufflevector(all, all, 2, 3, 0, 1, 6, 7, 4, 5));
        all = lesser(all, __builtin_shufflevector(all, all, 1, 0, 3, 2, 5, 4, 7, 6));
        return all[0];
    }

    static GRAFTAL_INLINE const float* side_of(const BoxNode& node, std::size_t side, int axis) {
        return reinterpret_cast<const float*>(&node.side[side][axis]);
    }

    static GRAFTAL_INLINE bool meets_together(const EvenPart& part) {
        return part.kind == EvenPart::Kind::cube || part.kind == EvenPart::Kind::triangle;
    }

    /// Whether so few rays go there that each goes by itself. A leaf is not worth the way there.
    GRAFTAL_INLINE bool is_left_alone(const Going& entry) const {
        return std::popcount(entry.mask) <= few &&
               (entry.entry & BoxNode::inner || !meets_together(model.even_parts[entry.entry]));
    }

    GRAFTAL_INLINE Next go_together(Going& going) {
        if (going.entry & BoxNode::inner) return test_boxes(going);
        const EvenPart& part = model.even_parts[going.entry];
        if (part.kind == EvenPart::Kind::node) return enter(part, going);
        if (!meets_together(part)) return Next::alone;
        meet_leaf(part, going);
        return Next::end;
    }

    GRAFTAL_INLINE Next enter(const EvenPart& part, Going& entry) {
        Frame& frame = room.frame(entry.frame + 1); // parents may move, but no more after this
        const Frame& parent = room.frames[entry.frame];
        if (!go_to_child(part, entry.entry, parent, frame)) return Next::end;
        const TraceNode& node = model.nodes[part.child];
        if (frame.cut && node.stop_tree == no_tree) return Next::alone;
        count(entry);
        Double8 least;
        for (int i = 0; i < 2; ++i) {
            const Double4 at = doubles_of(entry.at, i);
            for (int axis = 0; axis < 3; ++axis)
                frame.origin[axis].half[i] =
                    (parent.origin[axis].half[i] + at * direction[axis].half[i]) * splat(part.shrink) +
                    splat(part.shift[axis]);
            frame.base.half[i] = parent.base.half[i] + at * parent.unit.half[i];
            frame.unit.half[i] = parent.unit.half[i] * part.stretch;
            frame.speed.half[i] = parent.speed.half[i] * part.growth;
            least.half[i] = (range.least - frame.base.half[i]) * frame.speed.half[i];
        }
        frame.least = floats_of(least);
        frame.hits_then = UINT32_MAX;
        frame.first_least = smallest(frame.least, entry.mask);
        for (int axis = 0; axis < 3; ++axis) {
            frame.near[axis] = floats_of(frame.origin[axis]);
            frame.extreme[0][axis] = smallest(frame.near[axis], entry.mask);
            frame.extreme[1][axis] = greatest(frame.near[axis], entry.mask);
        }
        entry.at = Float8{};
        entry.box = Entry::no_box;
        ++entry.frame;
        if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            entry.entry = node.first_edge + node.edge_count;
            return Next::on;
        }
        const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame);
        entry.entry = tree | BoxNode::inner;
        return tree == no_tree ? Next::end : Next::on;
    }

    GRAFTAL_INLINE void count(const Going& entry) {
        const auto rays = static_cast<std::uint64_t>(std::popcount(entry.mask));
        visits += rays;
        self.visits_ += rays;
    }

    /// Four rays in a leaf's frame, and what counts of them there.
    struct Near {
        Double4 origin[3], along[3];
        Double4 base, unit, least, most;
        Long4 is_map; ///< false where the leaf's frame is none
    };

    GRAFTAL_INLINE Near bring_near(const EvenPart& part, const TraceEdge& edge, const Going& entry,
                                   int half) const {
        const Frame& parent = room.frames[entry.frame];
        const Double4 at = doubles_of(entry.at, half);
        Near near;
        near.base = parent.base.half[half] + at * parent.unit.half[half];
        Double4 from[3];
        for (int axis = 0; axis < 3; ++axis)
            from[axis] = parent.origin[axis].half[half] + at * direction[axis].half[half];
        Double4 growth = splat(part.growth), stretch = splat(part.stretch);
        near.is_map = growth == growth;
        if (part.upright) {
            for (int axis = 0; axis < 3; ++axis) {
                near.origin[axis] = from[axis] * splat(part.shrink) + splat(part.shift[axis]);
                near.along[axis] = direction[axis].half[half];
            }
        } else {
            const LaneMap& map = edge.child_from_parent;
            const auto through = [&](const Double4& x, const Double4& y, const Double4& z, int axis)
                                     GRAFTAL_INLINED_LAMBDA {
                                         return splat(map.column[0][axis]) * x +
                                                splat(map.column[1][axis]) * y +
                                                splat(map.column[2][axis]) * z;
                                     };
            for (int axis = 0; axis < 3; ++axis) {
                near.origin[axis] =
                    through(from[0], from[1], from[2], axis) + splat(map.translation[axis]);
                near.along[axis] = through(direction[0].half[half], direction[1].half[half],
                                           direction[2].half[half], axis);
            }
            if (!edge.similarity) {
                growth = largest_of(near.along);
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

    static GRAFTAL_INLINE Double4 size_of(const Double4& x) { return x < 0 ? -x : x; }

    /// As largest_component(), of four vectors.
    static GRAFTAL_INLINE Double4 largest_of(const Double4 (&vector)[3]) {
        const Double4 x = size_of(vector[0]), y = size_of(vector[1]), z = size_of(vector[2]);
        const Double4 xy = x < y ? y : x;
        return xy < z ? z : xy;
    }

    /// Where four rays cross a leaf first; `crossed`: which do.
    struct Crossing {
        Double4 t;
        Double4 normal[3];
        Long4 crossed;
    };

    /// As EvenKernel::meet_cube().
    GRAFTAL_INLINE Crossing cross_cube(const Near& near, int half) const {
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
            const Double4 outwards =
                ((near.along[axis] < 0) ^ entering) != 0 ? splat(-1.0) : splat(1.0);
            crossing.normal[axis] = here ? outwards : splat(0.0);
            here = axis == 0 ? other & (crossing.t == (entering ? enter[1] : leave[1])) : other & ~here;
            other = other & ~here;
        }
        return crossing;
    }

    /// As EvenKernel::meet_triangle().
    static GRAFTAL_INLINE Crossing cross_triangle(const Near& near) {
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

    GRAFTAL_INLINE void meet_leaf(const EvenPart& part, const Going& entry) {
        count(entry);
        const TraceEdge& edge = model.edges[entry.entry];
        Near near[2];
        Crossing crossing[2];
        Double8 t;
        std::uint32_t hit = 0, close = 0;
        for (int i = 0; i < 2; ++i) {
            near[i] = bring_near(part, edge, entry, i);
            crossing[i] =
                part.kind == EvenPart::Kind::cube ? cross_cube(near[i], i) : cross_triangle(near[i]);
            const Long4 crossed = crossing[i].crossed & near[i].is_map;
            t.half[i] = near[i].base + crossing[i].t * near[i].unit;
            hit |= bits_of<instructions>(crossed & (crossing[i].t < near[i].most)) << (4 * i);
            const Double4 slack = rounding * (size_of(t.half[i]) + size_of(near[i].base));
            close |= bits_of<instructions>(crossed & (size_of(t.half[i] - best.half[i]) <= slack)) << (4 * i);
        }
        hit &= entry.mask;
        tied = (tied & ~hit) | (close & entry.mask);
        if (hit == 0) return;
        found |= hit;
        const std::size_t number = keep_hit(part, entry);
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
    GRAFTAL_INLINE std::size_t keep_hit(const EvenPart& part, const Going& entry) {
        const Frame& parent = room.frames[entry.frame];
        PacketRoom::Hit& hit = room.hits.emplace_back();
        hit.is_upright = part.upright;
        if (!part.upright)
            place(parent, model.edges[entry.entry].parent_from_child, hit.world_from_leaf);
        hit.turns = part.turns;
        const TraceEdge& edge = model.edges[entry.entry]; // its look will be asked for
        __builtin_prefetch(&edge);
        __builtin_prefetch(&edge.tint);
        hit.way = room.ways.size();
        for (std::uint32_t i = 1; i <= entry.frame; ++i)
            room.ways.push_back(room.frames[i].edge);
        room.ways.push_back(entry.entry | (parent.cut ? from_cut : 0));
        hit.way_end = room.ways.size();
        return room.hits.size() - 1;
    }

    /// As much as the rounding of t may decide which of two hits is the nearer one, times some ten.
    static constexpr double rounding = 1e-14;

    /// From an entry on, as a ray by itself does.
    GRAFTAL_INLINE void go_alone(const Going& entry, int lane) {
        Alone alone(self, model, range);
        const int i = lane / 4, j = lane % 4;
        const auto of = [&](const Double8& lanes) GRAFTAL_INLINED_LAMBDA { return lanes.half[i][j]; };
        while (self.even_frames_.size() <= entry.frame)
            self.even_frames_.resize(2 * self.even_frames_.size());
        alone.frames = self.even_frames_.data();
        const Frame& parent = room.frames[entry.frame];
        EvenFrame& frame = alone.frames[entry.frame];
        static_cast<EvenPlace&>(frame) = parent;
        frame.origin = Double4{of(parent.origin[0]), of(parent.origin[1]), of(parent.origin[2]), 0};
        frame.base = of(parent.base);
        frame.unit = of(parent.unit);
        frame.speed = of(parent.speed);
        frame.near = __builtin_convertvector(frame.origin, Float4);
        frame.least = parent.least[lane];
        for (std::uint32_t above = 1; above < entry.frame; ++above)
            alone.frames[above].edge = room.frames[above].edge;
        alone.direction = Double4{of(direction[0]), of(direction[1]), of(direction[2]), 0};
        alone.inverse = Double4{of(inverse[0]), of(inverse[1]), of(inverse[2]), 0};
        alone.is_parallel = false;
        for (int axis = 0; axis < 3; ++axis) {
            alone.reciprocal[axis] = spread<instructions>(reciprocal[axis][lane]);
            alone.side_in[axis] = side_in[axis];
        }
        const double before = of(best), slack = rounding * (std::abs(before) + std::abs(frame.base));
        // Also what is a little farther: it may come first.
        self.best_.t = before < INFINITY ? before + 2 * slack : before;
        self.best_.found = false;
        self.visit_limit_ = self.visits_ + most_visits;
        const std::uint64_t visits_before = self.visits_;
        const bool met = alone.go_on({entry.at[lane], entry.entry, entry.frame});
        visits += self.visits_ - visits_before;
        if (self.hurries_) { // it is not given up yet
            self.hurries_ = false;
            --self.given_up_;
        }
        if (!met) return;
        const std::uint32_t bit = 1u << lane;
        if (before < INFINITY && !(self.best_.t < before - slack)) {
            tied |= bit;
            return;
        }
        keep_best(lane);
        tied &= ~bit;
        found |= bit;
    }

    GRAFTAL_INLINE void keep_best(int lane) {
        best.half[lane / 4][lane % 4] = self.best_.t;
        room.best[static_cast<std::size_t>(lane)] = {self.best_.t, room.hits.size(), self.best_.normal,
                                                     self.best_.point};
        PacketRoom::Hit& met = room.hits.emplace_back();
        met.is_upright = self.best_.is_upright;
        if (!met.is_upright) met.world_from_leaf = self.best_.world_from_leaf;
        met.turns = self.best_.turns;
        met.proxy_node = self.best_.proxy_node;
        met.way = room.ways.size();
        room.ways.insert(room.ways.end(), self.way_.begin(), self.way_.end());
        met.way_end = room.ways.size();
    }
};

} // namespace graftal
