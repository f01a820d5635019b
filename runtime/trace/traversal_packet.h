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

    PacketRoom& room;
    // In every frame:
    Double8 direction[3], inverse[3];
    Float8 reciprocal[3];
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
        room.push() = {Float8{}, 0, 0, 0, inside};
        while (room.top > 0) {
            Entry entry = room.entries[--room.top];
            if (!leave_out_beaten(entry)) continue;
            if (std::popcount(entry.mask) <= few || !go_together(entry))
                for (std::uint32_t left = entry.mask; left != 0; left &= left - 1)
                    go_alone(entry, std::countr_zero(left));
            if (visits > most_visits) {
                tied = all;
                return;
            }
        }
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
        }
        frame.offset = Double4{};
        frame.entry = frame.scale = 1;
        frame.steps = model.prepared.root_steps;
        frame.cut = false;
        frame.least_detail = model.least_detail_per_unit;
        return true;
    }

    /// Of rays that have met something, in the frame, as single precision tells; a little more.
    GRAFTAL_INLINE Float8 most_in(const Frame& frame) const {
        Double8 most;
        for (int i = 0; i < 2; ++i)
            most.half[i] = (best.half[i] - frame.base.half[i]) * frame.speed.half[i];
        return floats_of(most) + 2e-6f;
    }

    /// False if all rays have met something nearer than the entry is.
    GRAFTAL_INLINE bool leave_out_beaten(Entry& entry) const {
        if ((entry.mask & found) == 0) return true;
        entry.mask &= bits_of<instructions>(entry.at <= most_in(room.frames[entry.frame]));
        return entry.mask != 0;
    }

    /// Sorts the boxes that rays meet onto the stack, the nearest on top.
    GRAFTAL_INLINE void test_boxes(std::uint32_t number, std::uint32_t frame_number, std::uint32_t mask) {
        const BoxNode& node = model.boxes[number];
        const Frame& frame = room.frames[frame_number];
        const Float8 least = frame.least, most = most_in(frame);
        const Float8 near[3] = {frame.near[0], frame.near[1], frame.near[2]};
        const float* const in[3] = {side_of(node, side_in[0], 0), side_of(node, side_in[1], 1),
                                    side_of(node, side_in[2], 2)};
        const float* const out[3] = {side_of(node, 1 - side_in[0], 0), side_of(node, 1 - side_in[1], 1),
                                     side_of(node, 1 - side_in[2], 2)};
        const int lead = std::countr_zero(mask);
        Entry* const first = room.reserve(8);
        Entry* end = first;
        for (std::size_t child = 0; child < 8; ++child) {
            Float8 enters = least, leaves = most;
            for (int axis = 0; axis < 3; ++axis) {
                enters = greater(enters,
                                 (spread<instructions>(in[axis][child]) - near[axis]) * reciprocal[axis]);
                leaves = lesser(leaves,
                                (spread<instructions>(out[axis][child]) - near[axis]) * reciprocal[axis]);
            }
            const std::uint32_t meeting = bits_of<instructions>(enters <= leaves) & mask;
            if (meeting == 0) continue;
            const float key = enters[meeting >> lead & 1 ? lead : std::countr_zero(meeting)];
            Entry* place = end++;
            for (; place > first && place[-1].key < key; --place)
                *place = place[-1];
            *place = {enters, key, node.entry[child], frame_number, meeting};
        }
        room.top += static_cast<std::size_t>(end - first);
    }

    static GRAFTAL_INLINE const float* side_of(const BoxNode& node, std::size_t side, int axis) {
        return reinterpret_cast<const float*>(&node.side[side][axis]);
    }

    /// False if each ray is to go there by itself.
    GRAFTAL_INLINE bool go_together(const Entry& entry) {
        if (entry.entry & BoxNode::inner) {
            test_boxes(entry.entry & ~BoxNode::inner, entry.frame, entry.mask);
            return true;
        }
        const EvenPart& part = model.even_parts[entry.entry];
        if (part.kind == EvenPart::Kind::node) return enter(part, entry);
        if (part.kind != EvenPart::Kind::cube) return false;
        meet_cube(part, entry);
        return true;
    }

    GRAFTAL_INLINE bool enter(const EvenPart& part, const Entry& entry) {
        Frame& frame = room.frame(entry.frame + 1); // parents may move, but no more after this
        const Frame& parent = room.frames[entry.frame];
        if (!go_to_child(part, entry.entry, parent, frame)) return true;
        const TraceNode& node = model.nodes[part.child];
        if (frame.cut && node.stop_tree == no_tree) return false;
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
        for (int axis = 0; axis < 3; ++axis)
            frame.near[axis] = floats_of(frame.origin[axis]);
        if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            room.push() = {Float8{}, 0, node.first_edge + node.edge_count, entry.frame + 1, entry.mask};
            return true;
        }
        const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame);
        if (tree != no_tree)
            room.push() = {Float8{}, 0, tree | BoxNode::inner, entry.frame + 1, entry.mask};
        return true;
    }

    GRAFTAL_INLINE void count(const Entry& entry) {
        visits += static_cast<std::uint64_t>(std::popcount(entry.mask));
    }

    GRAFTAL_INLINE void meet_cube(const EvenPart& part, const Entry& entry) {
        count(entry);
        const Frame& parent = room.frames[entry.frame];
        std::uint32_t hit = 0, close = 0;
        Double8 ts;
        Double8 normal[3], point[3];
        for (int i = 0; i < 2; ++i) {
            const Double4 at = doubles_of(entry.at, i);
            const Double4 base = parent.base.half[i] + at * parent.unit.half[i];
            const Double4 unit = parent.unit.half[i] * part.stretch,
                          speed = parent.speed.half[i] * part.growth;
            const Double4 least = (range.least - base) * speed, most = (best.half[i] - base) * speed;
            Double4 enter[3], leave[3], origin[3];
            for (int axis = 0; axis < 3; ++axis) {
                origin[axis] =
                    (parent.origin[axis].half[i] + at * direction[axis].half[i]) * splat(part.shrink) +
                    splat(part.shift[axis]);
                const Double4 a = (-1 - origin[axis]) * inverse[axis].half[i],
                              b = (1 - origin[axis]) * inverse[axis].half[i];
                enter[axis] = b < a ? b : a;
                leave[axis] = a < b ? b : a;
            }
            const Double4 enter_xy = enter[0] < enter[1] ? enter[1] : enter[0],
                          leave_xy = leave[1] < leave[0] ? leave[1] : leave[0];
            const Double4 enters = enter_xy < enter[2] ? enter[2] : enter_xy,
                          leaves = leave[2] < leave_xy ? leave[2] : leave_xy;
            const Long4 entering = enters > least;
            const Double4 end = entering ? enters : leaves;
            const Long4 crossed = (enters <= leaves) & (end > least);
            const Double4 t = base + end * unit;
            const Long4 nearer = crossed & (end < most);
            hit |= bits_of<instructions>(nearer) << (4 * i);
            const Double4 apart = t < best.half[i] ? best.half[i] - t : t - best.half[i];
            const Double4 size = (t < 0 ? -t : t) + (base < 0 ? -base : base);
            close |= bits_of<instructions>(crossed & (apart <= rounding * size)) << (4 * i);
            ts.half[i] = t;
            Long4 other{};
            other = ~other;
            for (int axis = 0; axis < 3; ++axis) {
                const Long4 here =
                    axis == 2 ? other : other & (end == (entering ? enter[axis] : leave[axis]));
                const Double4 d = direction[axis].half[i];
                const Double4 along = d < 0 ? splat(-1.0) : splat(1.0);
                normal[axis].half[i] = here ? (entering ? -along : along) : splat(0.0);
                other = other & ~here;
                point[axis].half[i] = origin[axis] + end * d;
            }
        }
        hit &= entry.mask;
        close &= entry.mask;
        note_ties(hit, close);
        if (hit == 0) return;
        PacketRoom::Hit& met = room.hits.emplace_back();
        const TraceEdge& edge = model.edges[entry.entry];
        place(parent, edge.parent_from_child, met.world_from_leaf);
        met.turns = edge.turns;
        met.way = room.ways.size();
        for (std::uint32_t i = 1; i <= entry.frame; ++i)
            room.ways.push_back(room.frames[i].edge);
        room.ways.push_back(entry.entry | (parent.cut ? from_cut : 0));
        met.way_end = room.ways.size();
        for (std::uint32_t left = hit; left != 0; left &= left - 1) {
            const int lane = std::countr_zero(left), i = lane / 4, j = lane % 4;
            best.half[i][j] = room.t[static_cast<std::size_t>(lane)] = ts.half[i][j];
            room.hit_of[static_cast<std::size_t>(lane)] = room.hits.size() - 1;
            room.normal[static_cast<std::size_t>(lane)] = {normal[0].half[i][j], normal[1].half[i][j],
                                                           normal[2].half[i][j]};
            room.point[static_cast<std::size_t>(lane)] = {point[0].half[i][j], point[1].half[i][j],
                                                          point[2].half[i][j]};
        }
        found |= hit;
    }

    /// As much as the rounding of t may decide which of two hits is the nearer one, times some ten.
    static constexpr double rounding = 1e-14;

    GRAFTAL_INLINE void note_ties(std::uint32_t hit, std::uint32_t close) { tied = (tied & ~hit) | close; }

    /// From an entry on, as a ray by itself does.
    GRAFTAL_INLINE void go_alone(const Entry& entry, int lane) {
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
        self.visits_ = visits_before;
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
        const auto number = static_cast<std::size_t>(lane);
        best.half[lane / 4][lane % 4] = room.t[number] = self.best_.t;
        room.normal[number] = self.best_.normal;
        room.point[number] = self.best_.point;
        room.hit_of[number] = room.hits.size();
        PacketRoom::Hit& met = room.hits.emplace_back();
        met.world_from_leaf = self.best_.world_from_leaf;
        met.turns = self.best_.turns;
        met.proxy_node = self.best_.proxy_node;
        met.way = room.ways.size();
        room.ways.insert(room.ways.end(), self.way_.begin(), self.way_.end());
        met.way_end = room.ways.size();
    }
};

} // namespace graftal
