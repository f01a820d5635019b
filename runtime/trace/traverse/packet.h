#pragma once

// Eight rays at once: neighbours of a picture mostly look into the same parts. Each ray is taken into frames
// and meets leaves by the very operations of the way alone, in a lane of its own. Only the order differs in
// which parts are looked into. That matters only where two hits are all but equally near: such a ray goes
// again, alone. So a packet gives what its rays give one by one, to the last bit. This file has the common
// part of all packets: the boxes, the stack, and rays that leave the others. The ways of rays into frames
// are in packet_even.h and packet_turned.h. Only packets.cpp includes these.

#include <bit>
#include <cstring>
#include <span>
#include <utility>

#include "runtime/trace/traverse/packet_room.h"
#include "runtime/trace/traverse/ray_range.h"

namespace graftal {

/// `Packet`: what is derived from this. `PlacesOf` says which parts are looked into, `FrameOf` is the
/// packet's own frame.
template<Instructions instructions, typename Packet, typename PlacesOf, typename FrameOf>
struct Traversal::PacketWalk : PlacesOf {
    using Entry = PacketRoom::Entry;
    using Frame = FrameOf;
    using PlacesOf::model;
    using PlacesOf::self;

    /// Rays on their way into an entry.
    struct Going {
        Float8 at;     ///< from where on, in units from each ray's base
        float key = 0; ///< Entry's key
        std::uint32_t entry, frame, mask, box;
    };

    /// State of rays that went into something: they are at its end, or on their way into its nearest part,
    /// or each is to go there by itself.
    enum class Next { end, on, alone };

    PacketRoom& room;
    std::vector<Frame>& frames; ///< the room's
    Double8 least, best;        ///< of t
    std::uint32_t found = 0;    ///< rays that have met something
    std::uint32_t tied = 0;     ///< and something else about as near
    std::uint32_t lost = 0;     ///< rays that are to go alone, whatever they meet
    std::uint64_t visits = 0;
    std::span<const Ray> world_rays;

    GRAFTAL_INLINE PacketWalk(Traversal& traversal, std::vector<Frame>& packet_frames)
        : PlacesOf{traversal, traversal.model_, {}}, room(*traversal.packet_), frames(packet_frames) {}

    /// Rays that go alone: as few have little in common.
    static constexpr int few = 2;
    /// Most visits of a packet: then it is left to its rays, which may be given up.
    static constexpr std::uint64_t most_visits = 1 << 13;
    /// Difference of t within which rounding may decide which of two hits is the nearer one, times some ten.
    static constexpr double rounding = 1e-14;

    /// Fills in the room's hits.
    GRAFTAL_INLINE void run(std::span<const Ray> rays, const RayRange& range) {
        self.hurries_ = false;
        world_rays = rays;
        room.clear();
        for (int i = 0; i < 2; ++i) {
            least.half[i] = splat(range.least);
            best.half[i] = splat(range.most);
        }
        const std::uint32_t all = (1u << rays.size()) - 1;
        Going going{Float8{}, 0, 0, 0, all, Entry::no_box};
        const Next first = packet().enter_world(going);
        if (first == Next::alone) lost = all;
        if (first != Next::on) return;
        for (bool more = true; more || pop(going);) {
            const Next next = is_left_alone(going) ? Next::alone : go_together(going);
            more = next == Next::on;
            if (next == Next::alone)
                for (std::uint32_t left = going.mask; left != 0; left &= left - 1)
                    go_alone(going, std::countr_zero(left));
            if (visits > most_visits) {
                lost = all;
                return;
            }
        }
    }

    GRAFTAL_INLINE std::uint32_t to_go_alone() const { return tied | lost; }

    GRAFTAL_INLINE Packet& packet() { return static_cast<Packet&>(*this); }
    GRAFTAL_INLINE const Packet& packet() const { return static_cast<const Packet&>(*this); }

    static GRAFTAL_INLINE double of(const Double8& lanes, int lane) { return lanes.half[lane / 4][lane % 4]; }

    /// All rays of the world.
    GRAFTAL_INLINE void spread_rays(Double8 (&origin)[3], Double8 (&direction)[3]) const {
        for (std::size_t lane = 0; lane < 8; ++lane) {
            const Ray& ray = world_rays[std::min(lane, world_rays.size() - 1)];
            for (int axis = 0; axis < 3; ++axis) {
                origin[axis].half[lane / 4][lane % 4] = ray.origin[axis];
                direction[axis].half[lane / 4][lane % 4] = ray.direction[axis];
            }
        }
    }

    GRAFTAL_INLINE Frame& frame_after(std::uint32_t number) const {
        if (number + 1 >= frames.size()) frames.resize(2 * frames.size());
        return frames[number + 1];
    }

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

    /// False if all rays have met something nearer than the entry is.
    GRAFTAL_INLINE bool leave_out_beaten(Going& going) const {
        if ((going.mask & found) == 0) return true;
        going.mask &= bits_of<instructions>(going.at <= most_in(frames[going.frame]));
        return going.mask != 0;
    }

    /// Nearest hits of the rays so far, in the frame, in single precision; a little more.
    GRAFTAL_INLINE const Float8& most_in(Frame& frame) const {
        const auto hits = static_cast<std::uint32_t>(room.hits.size());
        if (frame.hits_then == hits) return frame.most;
        Double8 most;
        for (int i = 0; i < 2; ++i)
            most.half[i] = (best.half[i] - frame.base.half[i]) * frame.speed.half[i];
        frame.hits_then = hits;
        return frame.most = floats_of(most) + 2e-6f;
    }

    /// A side of eight boxes, as numbers: one of these is spread faster than a lane of a vector.
    static GRAFTAL_INLINE const float* side_of(const BoxNode& node, std::size_t side, int axis) {
        return reinterpret_cast<const float*>(&node.side[side][axis]);
    }

    /// The boxes of a packed node, of which lanes that hold none are not numbers.
    static GRAFTAL_INLINE void unpack(const PackedNode& packed, BoxNode& node) {
        for (std::size_t side = 0; side < 2; ++side)
            for (int axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<std::size_t>(axis);
                Byte8 bytes;
                std::memcpy(&bytes, packed.side[side][i].data(), sizeof(bytes));
                node.side[side][axis] =
                    spread<instructions>(packed.origin[i]) +
                    __builtin_convertvector(bytes, Float8) * spread<instructions>(packed.step[i]);
            }
        for (std::size_t lane = 0; lane < 8; ++lane)
            node.entry[lane] = packed.first + packed.offset[lane];
    }

    /// Sides of a box as all rays meet them on an axis: where they go in, and where they go out.
    struct Slab {
        Float8 in, out;
    };
    /// `near_in`, `near_out`: the origins as these sides see them.
    static GRAFTAL_INLINE Slab slab_of(float side_in, float side_out, const Float8& near_in,
                                       const Float8& near_out, const Float8& reciprocal) {
        return {(spread<instructions>(side_in) - near_in) * reciprocal,
                (spread<instructions>(side_out) - near_out) * reciprocal};
    }
    static GRAFTAL_INLINE Slab sorted(const Slab& slab, const Float8& reciprocal) {
        return {reciprocal < 0 ? slab.out : slab.in, reciprocal < 0 ? slab.in : slab.out};
    }

    /// Where rays enter the box of an entry, as test_boxes() has it.
    GRAFTAL_INLINE Float8 at_box(const Entry& entry) const {
        if (entry.box == Entry::no_box) return Float8{};
        const Frame& frame = frames[entry.frame];
        const std::uint32_t number = (entry.box & ~Entry::packed) / 8, child = entry.box % 8;
        Float8 enters = frame.least;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t in = packet().side_in(frame, axis);
            const bool mixed = packet().is_mixed(frame, axis);
            const auto side = [&](std::size_t of_two) GRAFTAL_INLINED_LAMBDA {
                if (!(entry.box & Entry::packed)) return side_of(model.boxes[number], of_two, axis)[child];
                const PackedNode& node = model.packed_boxes[number];
                const auto i = static_cast<std::size_t>(axis);
                return node.origin[i] + static_cast<float>(node.side[of_two][i][child]) * node.step[i];
            };
            const Float8& reciprocal = packet().reciprocal_of(frame, axis);
            Float8 at = (spread<instructions>(side(in)) - packet().near_of(frame, in, axis)) * reciprocal;
            if (mixed)
                at = reciprocal < 0
                         ? (spread<instructions>(side(1 - in)) - packet().near_of(frame, 1 - in, axis)) *
                               reciprocal
                         : at;
            enters = greater(enters, at);
        }
        return enters;
    }

    GRAFTAL_INLINE Next test_boxes(Going& going) {
        const std::uint32_t number = going.entry & ~BoxNode::inner;
        if (!(number & BoxNode::packed)) return test_boxes(model.boxes[number], 8 * number, going);
        const std::uint32_t packed = number & ~BoxNode::packed;
        BoxNode node;
        unpack(model.packed_boxes[packed], node);
        return test_boxes(node, 8 * packed | Entry::packed, going,
                          (1u << model.packed_boxes[packed].count) - 1);
    }

    /// Puts the nearest of the boxes that rays meet in the place of their node, and the others onto the
    /// stack, the farthest first. `used`: the lanes that hold boxes, others may.
    GRAFTAL_INLINE Next test_boxes(const BoxNode& node, std::uint32_t first_box, Going& going,
                                   std::uint32_t used = ~0u) {
        self.boxes_ += RayWork::boxes_of_packet;
        const std::uint32_t frame_number = going.frame, mask = going.mask;
        Frame& frame = frames[frame_number];
        const Float8 first_at = frame.least, most = most_in(frame);
        const float *in[3], *out[3];
        Float8 near_in[3], near_out[3], reciprocal[3];
        bool mixed = false;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t side = packet().side_in(frame, axis);
            in[axis] = side_of(node, side, axis);
            out[axis] = side_of(node, 1 - side, axis);
            near_in[axis] = packet().near_of(frame, side, axis);
            near_out[axis] = packet().near_of(frame, 1 - side, axis);
            reciprocal[axis] = packet().reciprocal_of(frame, axis);
            mixed = mixed || packet().is_mixed(frame, axis);
        }
        const int lead = std::countr_zero(mask);
        Entry* const first = room.reserve(8);
        Entry* end = first;
        bool none = true;
        for (std::uint32_t left = boxes_near(node, frame, most, mask) & used; left != 0; left &= left - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(left));
            Float8 enters = first_at, leaves = most;
            for (int axis = 0; axis < 3; ++axis) {
                Slab slab = slab_of(in[axis][child], out[axis][child], near_in[axis], near_out[axis],
                                    reciprocal[axis]);
                if (mixed && packet().is_mixed(frame, axis)) slab = sorted(slab, reciprocal[axis]);
                enters = greater(enters, slab.in);
                leaves = lesser(leaves, slab.out);
            }
            const std::uint32_t meeting = bits_of<instructions>(enters <= leaves) & mask;
            if (meeting == 0) continue;
            float key = enters[meeting >> lead & 1 ? lead : std::countr_zero(meeting)];
            std::uint32_t into = node.entry[child], rays = meeting,
                          box = first_box + static_cast<std::uint32_t>(child);
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

    /// Bits of the boxes that a ray of the packet may meet, by the extremes of all rays. Sums and products
    /// are rounded in order, so that none is left out.
    GRAFTAL_INLINE std::uint32_t boxes_near(const BoxNode& node, const Frame& frame, const Float8& most,
                                            std::uint32_t mask) const {
        Float8 enters = spread<instructions>(frame.first_least);
        Float8 leaves = spread<instructions>(greatest<instructions>(most, mask));
        for (int axis = 0; axis < 3; ++axis) {
            if (packet().is_mixed(frame, axis)) continue;
            const std::size_t in = packet().side_in(frame, axis);
            const Float8 from = node.side[in][axis] - spread<instructions>(packet().extreme_in(frame, axis)),
                         to = node.side[1 - in][axis] -
                              spread<instructions>(packet().extreme_out(frame, axis));
            const Float8 low = packet().least_reciprocal_of(frame, axis),
                         high = packet().most_reciprocal_of(frame, axis);
            enters = greater(enters, lesser(from * low, from * high));
            leaves = lesser(leaves, greater(to * low, to * high));
        }
        return bits_of<instructions>(enters <= leaves);
    }

    /// Whether so few rays go there that each goes by itself. A leaf is not worth the way there.
    GRAFTAL_INLINE bool is_left_alone(const Going& going) const {
        return std::popcount(going.mask) <= few &&
               (going.entry & BoxNode::inner || !packet().meets_together(going));
    }

    GRAFTAL_INLINE Next go_together(Going& going) {
        if (going.entry & BoxNode::inner) return test_boxes(going);
        return LeafGroup::is(going.entry) ? meet_group(going) : packet().enter(going);
    }

    /// The leaves of a group, one after the other.
    GRAFTAL_INLINE Next meet_group(Going& going) {
        if (!packet().meets_together(going)) return Next::alone;
        const LeafGroup group(going.entry);
        for (going.entry = group.first; going.entry < group.first + group.count; ++going.entry)
            packet().enter(going);
        return Next::end;
    }

    /// The rays are at the beginning of a frame that has them, and look into its boxes.
    GRAFTAL_INLINE Next go_in(const TraceNode& node, bool cut, std::uint32_t tree, Going& going) const {
        going.at = Float8{};
        going.box = Entry::no_box;
        ++going.frame;
        if (cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            going.entry = node.first_edge + node.edge_count;
            return Next::on;
        }
        going.entry = tree | BoxNode::inner;
        return tree == no_tree ? Next::end : Next::on;
    }

    /// Readies a frame: its rays begin where they are taken into it.
    GRAFTAL_INLINE void ready_rays(Frame& frame, const Float8 (&origin)[3], std::uint32_t mask) const {
        Double8 from;
        for (int i = 0; i < 2; ++i)
            from.half[i] = (least.half[i] - frame.base.half[i]) * frame.speed.half[i];
        frame.least = floats_of(from);
        frame.hits_then = UINT32_MAX;
        frame.first_least = smallest<instructions>(frame.least, mask);
        for (int axis = 0; axis < 3; ++axis) {
            frame.extreme[0][axis] = smallest<instructions>(origin[axis], mask);
            frame.extreme[1][axis] = greatest<instructions>(origin[axis], mask);
        }
    }

    GRAFTAL_INLINE void count(const Going& going) {
        const auto rays = static_cast<std::uint64_t>(std::popcount(going.mask));
        visits += rays;
        self.visits_ += rays;
    }

    /// From an entry on, as a ray by itself does.
    GRAFTAL_INLINE void go_alone(const Going& going, int lane) {
        const double before = of(best, lane),
                     slack = rounding * (std::abs(before) + std::abs(of(frames[going.frame].base, lane)));
        // Also what is a little farther: it may come first.
        self.best_.t = before < INFINITY ? before + 2 * slack : before;
        self.best_.found = false;
        self.ray_ = world_rays[static_cast<std::size_t>(lane)];
        self.visit_limit_ = self.visits_ + most_visits;
        self.met_flat_ = false;
        const std::uint64_t visits_before = self.visits_;
        const bool met = packet().resume(going, lane, {of(least, lane), before});
        visits += self.visits_ - visits_before;
        if (self.hurries_) { // the ray is not given up yet
            self.hurries_ = false;
            --self.given_up_;
        }
        const std::uint32_t bit = 1u << lane;
        if (self.met_flat_) lost |= bit; // its flat hits depend on those before
        if (!met || self.met_flat_) return;
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

    /// The edges to a frame's node.
    GRAFTAL_INLINE void keep_way(std::uint32_t frame_number, PacketRoom::Hit& hit) const {
        hit.way = room.ways.size();
        for (std::uint32_t i = 1; i <= frame_number; ++i)
            room.ways.push_back(frames[i].edge);
    }

    // Intersections (packet_leaves.h):
    struct Near {
        Double4 origin[3], along[3];
        Double4 base, unit, speed, least, most;
        Long4 is_map; ///< false where the leaf's frame is none
    };
    /// Where four rays cross a leaf first; `crossed`: which do.
    struct Crossing {
        Double4 t, in_world; ///< where, and as the world has it
        Double4 normal[3];
        Long4 crossed;
    };
    /// `inverse`: one over what the rays go along the axes.
    static Crossing cross_cube(const Near& near, const Double4 (&inverse)[3]);
    static Crossing cross_triangle(const Near& near);
    /// Sets the range of four rays that are where they start from.
    void ready_range(Near& near, int half) const;
    /// Meets what stands for a node that is cut, in whose frame the rays are; as keep_crossings().
    bool meet_proxy(const TraceNode& node, Near (&near)[2], std::uint32_t mask);
    /// Four rays that pass the unit sphere.
    static std::uint32_t passing_sphere(const Near& near);
    /// The crossing of each ray of the mask by itself.
    Crossing cross_any(const Primitive& primitive, const Near& near, int half, std::uint32_t mask) const;
    /// Whether any ray meets what it crosses before all else. If so, the last of the room's hits, which the
    /// caller adds to, is what they have met.
    bool keep_crossings(const Near (&near)[2], const Crossing (&crossing)[2], std::uint32_t mask);
};

} // namespace graftal
