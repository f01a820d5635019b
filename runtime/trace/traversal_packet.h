#pragma once

// Eight rays at once through even models: neighbours of a picture mostly look into the same parts. Each ray
// is taken into frames and meets leaves by the very operations of the way alone (traversal_even.h), in a lane
// of its own. What differs is the order in which parts are looked into. That matters only where two hits are
// all but equally near: such a ray goes again, alone. So a packet gives what its rays give one by one, to the
// last bit. Only traversal.cpp includes this.

#include <bit>
#include <utility>

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
    std::span<const Ray> world_rays;

    GRAFTAL_INLINE EvenPacket(Traversal& traversal, const TraceModel& traced, const RayRange& asked)
        : EvenPlaces{traversal, traced, asked}, room(*traversal.packet_) {}

    /// Fills in the room's hits; rays that are to go alone are in `tied`.
    GRAFTAL_INLINE void run(std::span<const Ray> rays) {
        self.hurries_ = false;
        world_rays = rays;
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

    /// What becomes of rays that go into something: they are at its end, on their way into the nearest of
    /// what is in it, or each is to go there by itself.
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
            const Double4 speed =
                power_below(largest_of(direction[0].half[i], direction[1].half[i], direction[2].half[i]));
            const Double4 unit = inverse_power(speed);
            Double4 least = range.least * speed, most = best.half[i] * speed;
            for (int axis = 0; axis < 3; ++axis) {
                direction[axis].half[i] = direction[axis].half[i] * unit;
                const Double4 d = direction[axis].half[i];
                const Double4 over = 1 / d;
                inverse[axis].half[i] = over;
                parallel |= bits_of<instructions>(size_of(d) < splat(parallel_to_plane));
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
            least_reciprocal[axis] = spread<instructions>(smallest<instructions>(reciprocal[axis], 0xff));
            most_reciprocal[axis] = spread<instructions>(greatest<instructions>(reciprocal[axis], 0xff));
        }
        frame.hits_then = UINT32_MAX;
        place_world(frame);
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

    /// Where rays enter the box of an entry, as test_boxes() has it.
    GRAFTAL_INLINE Float8 at_box(const Entry& entry) const {
        if (entry.box == Entry::no_box) return Float8{};
        const BoxNode& node = model.boxes[entry.box / 8];
        const Frame& frame = room.frames[entry.frame];
        Float8 enters = frame.least;
        for (int axis = 0; axis < 3; ++axis)
            enters =
                greater(enters, (spread<instructions>(side_of(node, side_in[axis], axis)[entry.box % 8]) -
                                 frame.near[axis]) *
                                    reciprocal[axis]);
        return enters;
    }

    /// False if all rays have met something nearer than the entry is.
    GRAFTAL_INLINE bool leave_out_beaten(Going& going) const {
        if ((going.mask & found) == 0) return true;
        going.mask &= bits_of<instructions>(going.at <= most_in(room.frames[going.frame]));
        return going.mask != 0;
    }

    /// Puts the nearest of the boxes that rays meet in the place of their node, and the others onto the
    /// stack, the farthest first.
    GRAFTAL_INLINE Next test_boxes(Going& going) {
        const std::uint32_t number = going.entry & ~BoxNode::inner, frame_number = going.frame,
                            mask = going.mask;
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
                enters =
                    greater(enters, (spread<instructions>(in[axis][child]) - near[axis]) * reciprocal[axis]);
                leaves =
                    lesser(leaves, (spread<instructions>(out[axis][child]) - near[axis]) * reciprocal[axis]);
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

    /// Which of eight boxes a ray of the packet may meet, as the extremes of all rays tell. Sums and products
    /// are rounded in order, so that none is left out.
    GRAFTAL_INLINE std::uint32_t boxes_near(const BoxNode& node, const Frame& frame, const Float8& most,
                                            std::uint32_t mask) const {
        Float8 enters = spread<instructions>(frame.first_least);
        Float8 leaves = spread<instructions>(greatest<instructions>(most, mask));
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t in = side_in[axis];
            const Float8 from = node.side[in][axis] - spread<instructions>(frame.extreme[1 - in][axis]),
                         to = node.side[1 - in][axis] - spread<instructions>(frame.extreme[in][axis]);
            enters = greater(enters, lesser(from * least_reciprocal[axis], from * most_reciprocal[axis]));
            leaves = lesser(leaves, greater(to * least_reciprocal[axis], to * most_reciprocal[axis]));
        }
        return bits_of<instructions>(enters <= leaves);
    }

    /// Of eight boxes; as numbers, of which one is spread sooner than a lane of a vector.
    static GRAFTAL_INLINE const float* side_of(const BoxNode& node, std::size_t side, int axis) {
        return reinterpret_cast<const float*>(&node.side[side][axis]);
    }

    static GRAFTAL_INLINE bool meets_together(const EvenPart& part) {
        return part.kind == EvenPart::Kind::cube || part.kind == EvenPart::Kind::triangle;
    }

    /// Whether so few rays go there that each goes by itself. A leaf is not worth the way there.
    GRAFTAL_INLINE bool is_left_alone(const Going& going) const {
        return std::popcount(going.mask) <= few && !LeafGroup::is(going.entry) &&
               (going.entry & BoxNode::inner || !meets_together(model.even_parts[going.entry]));
    }

    GRAFTAL_INLINE Next go_together(Going& going) {
        if (going.entry & BoxNode::inner) return test_boxes(going);
        if (LeafGroup::is(going.entry)) {
            const LeafGroup group(going.entry);
            for (going.entry = group.first; going.entry < group.first + group.count; ++going.entry)
                meet_leaf(model.even_parts[going.entry], going);
            return Next::end;
        }
        const EvenPart& part = model.even_parts[going.entry];
        if (part.kind == EvenPart::Kind::node) return enter(part, going);
        if (!meets_together(part)) return Next::alone;
        meet_leaf(part, going);
        return Next::end;
    }

    GRAFTAL_INLINE Next enter(const EvenPart& part, Going& going) {
        Frame& frame = room.frame(going.frame + 1); // parents may move, but no more after this
        const Frame& parent = room.frames[going.frame];
        if (!go_to_child(part, going.entry, parent, frame)) return Next::end;
        const TraceNode& node = model.nodes[part.child];
        if (frame.cut && node.stop_tree == no_tree) return Next::alone;
        count(going);
        Double8 least;
        for (int i = 0; i < 2; ++i) {
            const Double4 at = doubles_of(going.at, i);
            for (int axis = 0; axis < 3; ++axis)
                frame.origin[axis].half[i] =
                    (parent.origin[axis].half[i] + at * direction[axis].half[i]) * splat(part.shrink()) +
                    splat(part.shift[axis]);
            frame.base.half[i] = parent.base.half[i] + at * parent.unit.half[i];
            frame.unit.half[i] = parent.unit.half[i] * part.stretch;
            frame.speed.half[i] = parent.speed.half[i] * part.growth;
            least.half[i] = (range.least - frame.base.half[i]) * frame.speed.half[i];
        }
        frame.least = floats_of(least);
        frame.hits_then = UINT32_MAX;
        frame.first_least = smallest<instructions>(frame.least, going.mask);
        for (int axis = 0; axis < 3; ++axis) {
            frame.near[axis] = floats_of(frame.origin[axis]);
            frame.extreme[0][axis] = smallest<instructions>(frame.near[axis], going.mask);
            frame.extreme[1][axis] = greatest<instructions>(frame.near[axis], going.mask);
        }
        going.at = Float8{};
        going.box = Entry::no_box;
        ++going.frame;
        if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            going.entry = node.first_edge + node.edge_count;
            return Next::on;
        }
        const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame, part, parent);
        going.entry = tree | BoxNode::inner;
        return tree == no_tree ? Next::end : Next::on;
    }

    GRAFTAL_INLINE void count(const Going& going) {
        const auto rays = static_cast<std::uint64_t>(std::popcount(going.mask));
        visits += rays;
        self.visits_ += rays;
    }

    // What is met (traversal_packet_leaves.h):
    /// Four rays in a leaf's frame, and what counts of them there.
    struct Near {
        Double4 origin[3], along[3];
        Double4 base, unit, least, most;
        Long4 is_map; ///< false where the leaf's frame is none
    };

    /// Four rays of those on their way into a leaf.
    Near bring_near(const EvenPart& part, const TraceEdge& edge, const Going& going, int half) const;

    /// Where four rays cross a leaf first; `crossed`: which do.
    struct Crossing {
        Double4 t;
        Double4 normal[3];
        Long4 crossed;
    };
    Crossing cross_cube(const Near& near, int half) const;
    static Crossing cross_triangle(const Near& near);
    void meet_leaf(const EvenPart& part, const Going& going);
    std::size_t keep_hit(const EvenPart& part, const Going& going);

    /// As much as the rounding of t may decide which of two hits is the nearer one, times some ten.
    static constexpr double rounding = 1e-14;

    /// From an entry on, as a ray by itself does.
    GRAFTAL_INLINE void go_alone(const Going& going, int lane) {
        Alone alone(self, model, range);
        const int i = lane / 4, j = lane % 4;
        const auto of = [&](const Double8& lanes) GRAFTAL_INLINED_LAMBDA { return lanes.half[i][j]; };
        while (self.even_frames_.size() <= going.frame)
            self.even_frames_.resize(2 * self.even_frames_.size());
        alone.frames = self.even_frames_.data();
        const Frame& parent = room.frames[going.frame];
        EvenFrame& frame = alone.frames[going.frame];
        static_cast<EvenPlace&>(frame) = parent;
        frame.origin = Double4{of(parent.origin[0]), of(parent.origin[1]), of(parent.origin[2]), 0};
        frame.base = of(parent.base);
        frame.unit = of(parent.unit);
        frame.speed = of(parent.speed);
        frame.near = __builtin_convertvector(frame.origin, Float4);
        frame.least = parent.least[lane];
        for (std::uint32_t above = 1; above < going.frame; ++above)
            alone.frames[above].edge = room.frames[above].edge;
        alone.direction = Double4{of(direction[0]), of(direction[1]), of(direction[2]), 0};
        alone.inverse = Double4{of(inverse[0]), of(inverse[1]), of(inverse[2]), 0};
        alone.is_parallel = false;
        for (int axis = 0; axis < 3; ++axis)
            alone.reciprocal[axis] = spread<instructions>(reciprocal[axis][lane]);
        alone.set_sides(side_in);
        alone.first_placed = going.frame;
        const double before = of(best), slack = rounding * (std::abs(before) + std::abs(frame.base));
        // Also what is a little farther: it may come first.
        self.best_.t = before < INFINITY ? before + 2 * slack : before;
        self.best_.found = false;
        self.ray_ = world_rays[static_cast<std::size_t>(lane)];
        self.visit_limit_ = self.visits_ + most_visits;
        const std::uint64_t visits_before = self.visits_;
        const bool met = alone.go_on({going.at[lane], going.entry, going.frame});
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
        met.in_world = self.best_.in_world;
        met.way = room.ways.size();
        room.ways.insert(room.ways.end(), self.way_.begin(), self.way_.end());
        met.way_end = room.ways.size();
    }
};

} // namespace graftal
