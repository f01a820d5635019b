#pragma once

// Eight rays at once, through an even model: neighbours of a picture mostly look into the same parts. Each
// ray is taken into frames and meets leaves by the very operations of the way alone (even.h), in a lane of
// its own. Only the order differs in which parts are looked into. That matters only where two hits are all
// but equally near: such a ray goes again, alone. So a packet gives what its rays give one by one, to the
// last bit. Only packets.cpp includes this.

#include <bit>
#include <span>
#include <utility>

#include "runtime/trace/traverse/even.h"
#include "runtime/trace/traverse/packet_room.h"
#include "runtime/trace/traverse/ray_range.h"

namespace graftal {

template<Instructions instructions> struct Traversal::Packet : EvenPlaces {
    using Entry = PacketRoom::Entry;
    using Frame = PacketRoom::Frame;

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
    // In every frame:
    Double8 direction[3], inverse[3];
    Float8 reciprocal[3];
    Float8 least_reciprocal[3], most_reciprocal[3]; ///< of all rays
    std::size_t sides[3];                           ///< of boxes, where rays go in
    Double8 best;                                   ///< of t
    std::uint32_t found = 0;                        ///< rays that have met something
    std::uint32_t tied = 0;                         ///< and something else about as near
    std::uint32_t lost = 0;                         ///< rays that are to go alone, whatever they meet
    std::uint64_t visits = 0;
    std::span<const Ray> world_rays;

    GRAFTAL_INLINE Packet(Traversal& traversal, std::span<const Ray> rays, const RayRange& asked)
        : EvenPlaces{traversal, traversal.model_, asked}, room(*traversal.packet_), frames(room.frames),
          world_rays(rays) {}

    /// Rays that go alone: as few have little in common.
    static constexpr int few = 2;
    /// Most visits of a packet: then it is left to its rays, which may be given up.
    static constexpr std::uint64_t most_visits = 1 << 13;
    /// Difference of t within which rounding may decide which of two hits is the nearer one, times some ten.
    static constexpr double rounding = 1e-14;

    /// Fills in the room's hits.
    GRAFTAL_INLINE void run() {
        self.hurries_ = false;
        room.clear();
        best.half[0] = best.half[1] = splat(range.most);
        const std::uint32_t all = (1u << world_rays.size()) - 1;
        Going going{Float8{}, 0, 0, 0, all, Entry::no_box};
        const Next first = enter_world(going);
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

    static GRAFTAL_INLINE double of(const Double8& lanes, int lane) { return lanes.half[lane / 4][lane % 4]; }

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
            if ((going.mask & found) == 0) return true;
            going.mask &= bits_of<instructions>(going.at <= most_in(frames[going.frame]));
            if (going.mask != 0) return true;
        }
        return false;
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

    /// Where rays enter the box of an entry, as test_boxes() has it.
    GRAFTAL_INLINE Float8 at_box(const Entry& entry) const {
        if (entry.box == Entry::no_box) return Float8{};
        const Frame& frame = frames[entry.frame];
        const BoxNode& node = model.boxes[entry.box / 8];
        Float8 enters = frame.least;
        for (int axis = 0; axis < 3; ++axis) {
            const float side = side_of(node, sides[axis], axis)[entry.box % 8];
            enters = greater(enters, (spread<instructions>(side) - frame.near[axis]) * reciprocal[axis]);
        }
        return enters;
    }

    /// Puts the nearest of the boxes that rays meet in the place of their node, and the others onto the
    /// stack, the farthest first.
    GRAFTAL_INLINE Next test_boxes(Going& going) {
        self.boxes_ += RayWork::boxes_of_packet;
        const std::uint32_t number = going.entry & ~BoxNode::inner;
        const BoxNode& node = model.boxes[number];
        const std::uint32_t frame_number = going.frame, mask = going.mask;
        Frame& frame = frames[frame_number];
        const Float8 first_at = frame.least, most = most_in(frame);
        const float *in[3], *out[3];
        for (int axis = 0; axis < 3; ++axis) {
            in[axis] = side_of(node, sides[axis], axis);
            out[axis] = side_of(node, 1 - sides[axis], axis);
        }
        const int lead = std::countr_zero(mask);
        Entry* const first = room.reserve(8);
        Entry* end = first;
        bool none = true;
        for (std::uint32_t left = boxes_near(node, frame, most, mask); left != 0; left &= left - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(left));
            Float8 enters = first_at, leaves = most;
            for (int axis = 0; axis < 3; ++axis) {
                enters = greater(enters, (spread<instructions>(in[axis][child]) - frame.near[axis]) *
                                             reciprocal[axis]);
                leaves = lesser(leaves, (spread<instructions>(out[axis][child]) - frame.near[axis]) *
                                            reciprocal[axis]);
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

    /// Bits of the boxes that a ray of the packet may meet, by the extremes of all rays. Sums and products
    /// are rounded in order, so that none is left out.
    GRAFTAL_INLINE std::uint32_t boxes_near(const BoxNode& node, const Frame& frame, const Float8& most,
                                            std::uint32_t mask) const {
        Float8 enters = spread<instructions>(frame.first_least);
        Float8 leaves = spread<instructions>(greatest<instructions>(most, mask));
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t in = sides[axis], out = 1 - in;
            const Float8 from = node.side[in][axis] - spread<instructions>(frame.extreme[out][axis]),
                         to = node.side[out][axis] - spread<instructions>(frame.extreme[in][axis]);
            const Float8 low = least_reciprocal[axis], high = most_reciprocal[axis];
            enters = greater(enters, lesser(from * low, from * high));
            leaves = lesser(leaves, greater(to * low, to * high));
        }
        return bits_of<instructions>(enters <= leaves);
    }

    /// Whether so few rays go there that each goes by itself. A leaf is not worth the way there.
    GRAFTAL_INLINE bool is_left_alone(const Going& going) const {
        if (std::popcount(going.mask) > few) return false;
        return going.entry & BoxNode::inner ||
               (!LeafGroup::is(going.entry) && model.even_parts[going.entry].kind == EvenPart::Kind::node);
    }

    GRAFTAL_INLINE Next go_together(Going& going) {
        if (going.entry & BoxNode::inner) return test_boxes(going);
        return LeafGroup::is(going.entry) ? meet_group(going) : enter(going);
    }

    /// The leaves of a group, one after the other.
    GRAFTAL_INLINE Next meet_group(Going& going) {
        const LeafGroup group(going.entry);
        for (going.entry = group.first; going.entry < group.first + group.count; ++going.entry)
            enter(going);
        return Next::end;
    }

    /// Readies a frame: its rays begin where they are taken into it.
    GRAFTAL_INLINE void ready_rays(Frame& frame, std::uint32_t mask) const {
        Double8 from;
        for (int i = 0; i < 2; ++i)
            from.half[i] = (range.least - frame.base.half[i]) * frame.speed.half[i];
        frame.least = floats_of(from);
        frame.hits_then = UINT32_MAX;
        frame.first_least = smallest<instructions>(frame.least, mask);
        for (int axis = 0; axis < 3; ++axis) {
            frame.near[axis] = floats_of(frame.origin[axis]);
            frame.extreme[0][axis] = smallest<instructions>(frame.near[axis], mask);
            frame.extreme[1][axis] = greatest<instructions>(frame.near[axis], mask);
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
        const std::uint64_t visits_before = self.visits_;
        const bool met = resume(going, lane, {range.least, before});
        visits += self.visits_ - visits_before;
        if (self.hurries_) { // the ray is not given up yet
            self.hurries_ = false;
            --self.given_up_;
        }
        const std::uint32_t bit = 1u << lane;
        if (!met) return;
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

    /// Brings all rays to the box of the model. They are to go alone if they do not go to the same sides of
    /// boxes, or along some.
    GRAFTAL_INLINE Next enter_world(Going& going) {
        Frame& frame = frames[0];
        Double8 origin[3];
        for (std::size_t lane = 0; lane < 8; ++lane) {
            const Ray& ray = world_rays[std::min(lane, world_rays.size() - 1)];
            for (int axis = 0; axis < 3; ++axis) {
                origin[axis].half[lane / 4][lane % 4] = ray.origin[axis];
                direction[axis].half[lane / 4][lane % 4] = ray.direction[axis];
            }
        }
        const Box box = enlarged(model.edges.front().box, Vec3(0.0));
        std::uint32_t parallel = 0, inside = 0;
        for (int i = 0; i < 2; ++i) {
            const Double4 speed =
                power_below(largest_of(direction[0].half[i], direction[1].half[i], direction[2].half[i]));
            const Double4 unit = inverse_power(speed);
            Double4 from = range.least * speed, to = best.half[i] * speed;
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
        place_world(frame);
        going.mask &= inside;
        return going.mask != 0 ? Next::on : Next::end;
    }

    GRAFTAL_INLINE Next enter(Going& going) {
        const EvenPart& part = model.even_parts[going.entry];
        if (part.kind != EvenPart::Kind::node) {
            meet_leaf(part, going);
            return Next::end;
        }
        Frame& frame = frame_after(going.frame); // parents may move, but no more after this
        const Frame& parent = frames[going.frame];
        if (!go_to_child(part, going.entry, parent, frame)) return Next::end;
        const TraceNode& node = model.nodes[part.child];
        const bool is_proxy = frame.cut && node.stop_tree == no_tree;
        if (is_proxy && node.faint) return Next::alone;
        count(going);
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
        ready_rays(frame, going.mask);
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

    /// Takes one ray on alone from an entry on; true if it met something nearer.
    GRAFTAL_INLINE bool resume(const Going& going, int lane, const RayRange& left) const {
        EvenKernel<instructions, false> alone(self, model, left);
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
    /// Four rays of those on their way into a leaf.
    Near bring_near(const EvenPart& part, const TraceEdge& edge, const Going& going, int half) const;
    void meet_leaf(const EvenPart& part, const Going& going);
    /// Meets the stand-in of the frame's node, which is cut, and the next after that where the rays are.
    void meet_proxy(const TraceNode& node, const Frame& frame, const Going& going);
    /// Four rays that pass the unit sphere.
    static std::uint32_t passing_sphere(const Near& near);
    /// The crossing of each ray of the mask by itself.
    Crossing cross_any(const Primitive& primitive, const Near& near, int half, std::uint32_t mask) const;
    /// Whether any ray meets what it crosses before all else. If so, the last of the room's hits, which the
    /// caller adds to, is what they have met.
    bool keep_crossings(const Near (&near)[2], const Crossing (&crossing)[2], std::uint32_t mask);
};

} // namespace graftal
