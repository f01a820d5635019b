#pragma once

// How rays go through models whose parts are only scaled evenly and moved, and drawn no wider than they are:
// the general way (traversal_kernel.h) without what such models never ask for. The ray has one direction in
// all frames; of a frame's place a scale and an offset are left. Only traversal.cpp includes this.

#include "compiler/primitives/passage.h"
#include "runtime/trace/traversal_even_places.h"

namespace graftal {

template<Instructions instructions, bool any> struct Traversal::EvenKernel : EvenPlaces {
    EvenFrame* frames; ///< and entries: Traversal's
    EvenEntry* entries;
    EvenEntry* top; ///< behind the last entry in use
    // In every frame:
    Double4 direction, inverse;
    bool is_parallel;       ///< to some of a cube's faces
    Float8 reciprocal[3];   ///< of the direction, never infinite
    std::size_t side_in[3]; ///< of boxes

    using Entry = EvenEntry;
    using Frame = EvenFrame;

    GRAFTAL_INLINE explicit EvenKernel(Traversal& traversal, const TraceModel& traced, const RayRange& asked)
        : EvenPlaces{traversal, traced, asked}, frames(self.even_frames_.data()),
          entries(self.even_entries_.data()), top(entries) {}

    GRAFTAL_INLINE bool run(const Ray& ray) {
        self.best_.found = false;
        self.best_.t = range.most;
        self.ray_ = ray;
        self.visit_limit_ = self.visits_ + model.most_visits;
        self.hurries_ = false;
        Entry entry;
        return enter_world(ray, entry) && go_on(entry);
    }

    /// From an entry on, until nothing is left; true if something nearer was met.
    GRAFTAL_INLINE bool go_on(Entry entry) {
        for (bool more = true; more || pop(entry);) {
            if (entry.entry & BoxNode::inner) {
                more = test_boxes(entry.entry & ~BoxNode::inner, entry.frame, entry);
                continue;
            }
            more = enter(entry);
            if (any && self.best_.found) return true;
            if (self.visits_ > self.visit_limit_ && !self.goes_on()) break;
        }
        return self.best_.found;
    }

    /// Takes the nearest entry, if one is left that is nearer than the best hit.
    GRAFTAL_INLINE bool pop(Entry& entry) {
        while (top != entries) {
            entry = *--top;
            const Frame& frame = frames[entry.frame];
            if (frame.base + static_cast<double>(entry.at) * frame.unit < self.best_.t) return true;
        }
        return false;
    }

    GRAFTAL_INLINE bool enter_world(const Ray& ray, Entry& entry) {
        Frame& frame = frames[0];
        const Double4 origin = lanes_of(ray.origin);
        direction = lanes_of(ray.direction);
        frame.speed = largest_component(direction);
        frame.unit = 1 / frame.speed;
        direction = direction * splat(frame.unit);
        inverse = 1 / direction;
        const Double4 magnitude = direction < 0 ? -direction : direction;
        is_parallel = (bits_of<instructions>(magnitude < splat(parallel_to_plane)) & 7) != 0;
        const RayRange within{range.least * frame.speed, self.best_.t * frame.speed};
        const Box box = enlarged(model.edges.front().box, Vec3(0.0));
        const RayRange inside = is_parallel ? range_in(box, {vec3_of(origin), vec3_of(direction)}, within)
                                            : range_between(box, origin, within);
        if (!(inside.least <= inside.most)) return false;
        frame.origin = origin + splat(inside.least) * direction;
        frame.base = inside.least * frame.unit;
        frame.offset = Double4{};
        frame.entry = frame.scale = 1;
        frame.steps = model.prepared.root_steps;
        frame.cut = false;
        frame.least_detail = model.least_detail_per_unit;
        const Float4 divisor = never_zero(__builtin_convertvector(direction, Float4));
        const Float4 quotient = 1 / divisor;
        for (int axis = 0; axis < 3; ++axis) {
            reciprocal[axis] = spread<instructions>(quotient[axis]);
            side_in[axis] = quotient[axis] < 0 ? 1 : 0;
        }
        entry = {0, 0, 0};
        return true;
    }

    /// As range_in(), of a ray that is parallel to no side.
    GRAFTAL_INLINE RayRange range_between(const Box& box, const Double4& origin, RayRange within) const {
        const Double4 a = (lanes_of(box.min) - origin) * inverse, b = (lanes_of(box.max) - origin) * inverse;
        for (int axis = 0; axis < 3; ++axis) {
            within.least = std::max(within.least, std::min(a[axis], b[axis]));
            within.most = std::min(within.most, std::max(a[axis], b[axis]));
        }
        return within;
    }

    GRAFTAL_INLINE bool test_boxes(std::uint32_t number, std::uint32_t frame_number, Entry& nearest) {
        const BoxNode& node = model.boxes[number];
        const Frame& frame = frames[frame_number];
        // A little more, for what single precision leaves out.
        const float most = static_cast<float>((self.best_.t - frame.base) * frame.speed) + 2e-6f;
        Float8 enters = spread<instructions>(frame.least), leaves = spread<instructions>(most);
        for (int axis = 0; axis < 3; ++axis) {
            const Float8 origin = spread<instructions>(frame.near[axis]);
            // Lanes of no numbers stay so by the last axis.
            enters = greater(enters, (node.side[side_in[axis]][axis] - origin) * reciprocal[axis]);
            leaves = lesser(leaves, (node.side[1 - side_in[axis]][axis] - origin) * reciprocal[axis]);
        }
        std::uint32_t lanes = bits_of<instructions>(enters <= leaves);
        if (lanes == 0) return false;
        const auto entry_of = [&](std::uint32_t bits) GRAFTAL_INLINED_LAMBDA {
            const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
            return Entry{enters[lane], node.entry[lane], frame_number};
        };
        nearest = entry_of(lanes);
        lanes &= lanes - 1;
        if (lanes == 0) return true;
        reserve_entries();
        Entry* const first = top;
        do {
            Entry entry = entry_of(lanes);
            if (entry.at <= nearest.at) std::swap(entry, nearest);
            Entry* place = top++;
            for (; place > first && place[-1].at < entry.at; --place)
                *place = place[-1];
            *place = entry;
        } while ((lanes &= lanes - 1) != 0);
        return true;
    }

    /// For the others of eight.
    GRAFTAL_INLINE void reserve_entries() {
        const auto count = static_cast<std::size_t>(top - entries);
        if (count + 7 <= self.even_entries_.size()) return;
        self.even_entries_.resize(2 * self.even_entries_.size());
        entries = self.even_entries_.data();
        top = entries + count;
    }

    /// Puts the nearest of what it leads to in its place; false if there is nothing.
    GRAFTAL_INLINE bool enter(Entry& entry) {
        ++self.visits_;
        const EvenPart& part = model.even_parts[entry.entry];
        if (part.kind != EvenPart::Kind::node) {
            meet_leaf(part, frames[entry.frame], entry);
            return false;
        }
        const std::uint32_t number = entry.frame + 1;
        if (number == self.even_frames_.size()) {
            self.even_frames_.resize(2 * number);
            frames = self.even_frames_.data();
        }
        const Frame& parent = frames[entry.frame];
        Frame& frame = frames[number];
        const double at = entry.at;
        frame.base = parent.base + at * parent.unit;
        frame.speed = parent.speed * part.growth;
        frame.unit = parent.unit * part.stretch;
        frame.origin = (parent.origin + splat(at) * direction) * splat(part.shrink) + part.shift;
        if (!go_to_child(part, entry.entry, parent, frame)) return false;
        const TraceNode& node = model.nodes[part.child];
        if (frame.cut && node.stop_tree == no_tree) {
            meet_proxy(node, frame, number);
            return false;
        }
        frame.least = static_cast<float>((range.least - frame.base) * frame.speed);
        frame.near = __builtin_convertvector(frame.origin, Float4);
        if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            entry = {0, node.first_edge + node.edge_count, number};
            return true;
        }
        const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame);
        return tree != no_tree && test_boxes(tree, number, entry);
    }

    GRAFTAL_INLINE void meet_leaf(const EvenPart& part, const Frame& parent, const Entry& entry) {
        const double at = entry.at, base = parent.base + at * parent.unit;
        const Double4 near = parent.origin + splat(at) * direction;
        PrimitiveHit hit;
        Vec3 origin, along;
        double unit;
        if (part.kind == EvenPart::Kind::cube && !is_parallel) {
            origin = vec3_of(near * splat(part.shrink) + part.shift);
            along = vec3_of(direction);
            unit = parent.unit * part.stretch;
            if (!meet_cube(origin, range_from(base, parent.speed * part.growth), hit)) return;
        } else {
            const TraceEdge& edge = model.edges[entry.entry];
            if (!edge.similarity) self.more_work_ += RayWork::stretched;
            const Double4 turned = direction_through(edge.child_from_parent, direction);
            const double largest = edge.similarity ? edge.growth : largest_component(turned);
            if (!(largest > 0 && largest < 1 / least_scale)) return;
            const double shrink = edge.similarity ? edge.stretch : 1 / largest;
            origin = vec3_of(edge.upright ? near * splat(part.shrink) + part.shift
                                          : point_through(edge.child_from_parent, near));
            along = vec3_of(edge.upright ? direction : turned * splat(shrink));
            unit = parent.unit * shrink;
            const RayRange near_range = range_from(base, parent.speed * largest);
            if (part.kind == EvenPart::Kind::triangle) {
                if (!meet_triangle({origin, along}, near_range, hit)) return;
            } else if (!intersect(model.nodes[part.child].primitive, {origin, along}, near_range, hit)) {
                return;
            }
        }
        set_best(base + hit.t * unit, hit.normal);
        if (any) return;
        prefetch_look(entry.entry);
        self.best_.point = origin + hit.t * along;
        self.best_.turns = part.turns;
        self.best_.proxy_node = no_edge;
        self.best_.is_upright = part.upright;
        if (!part.upright)
            place(parent, model.edges[entry.entry].parent_from_child, self.best_.world_from_leaf);
        keep_way(entry.frame);
        self.way_.push_back(entry.entry | (parent.cut ? from_cut : 0));
    }

    /// As the primitive is met (cube.cpp).
    GRAFTAL_INLINE bool meet_cube(const Vec3& origin, const RayRange& near, PrimitiveHit& hit) const {
        Passage sides[3];
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (-1 - origin[axis]) * inverse[axis], b = (1 - origin[axis]) * inverse[axis];
            sides[axis] = {std::min(a, b), std::max(a, b)};
        }
        PassageEnd end;
        if (!first_end(both(both(sides[0], sides[1]), sides[2]), near, end)) return false;
        hit = {end.t, Vec3(0.0)};
        const int axis = end.t == end.of(sides[0]) ? 0 : end.t == end.of(sides[1]) ? 1 : 2;
        hit.normal[axis] = end.outwards(direction[axis]);
        return true;
    }

    /// Likewise (triangle.cpp).
    GRAFTAL_INLINE bool meet_triangle(const Ray& ray, const RayRange& near, PrimitiveHit& hit) const {
        constexpr double root3 = 1.7320508075688772;
        const double t = -ray.origin.z / ray.direction.z;
        if (!holds(near, t)) return false;
        const double x = ray.origin.x + t * ray.direction.x, y = ray.origin.y + t * ray.direction.y;
        if (!(y >= -0.5 - passage_rounding && root3 * std::abs(x) + y <= 1 + passage_rounding)) return false;
        hit = {t, {0, 0, 1}};
        return true;
    }

    /// What stands for the frame's own node.
    GRAFTAL_INLINE void meet_proxy(const TraceNode& node, const Frame& frame, std::uint32_t number) {
        if (node.faint) {
            LaneMap world_from_proxy;
            place(frame, node.node_from_proxy, world_from_proxy);
            if (!self.meet_leaf(PrimitiveKind::sphere, world_from_proxy.affine(), true,
                                world_ball(node, frame, node.ball_radius), range))
                return;
        } else {
            const Double4 origin = point_through(node.proxy_from_node, frame.origin);
            const Double4 turned = direction_through(node.proxy_from_node, direction);
            const double largest = largest_component(turned), unit = 1 / largest;
            PrimitiveHit hit;
            if (!intersect(PrimitiveKind::sphere, {vec3_of(origin), vec3_of(turned * splat(unit))},
                           range_from(frame.base, frame.speed * largest), hit))
                return;
            set_best(frame.base + hit.t * (frame.unit * unit), hit.normal);
            place(frame, node.node_from_proxy, self.best_.world_from_leaf);
        }
        self.best_.proxy_node = frame.node;
        keep_way(number);
    }

    GRAFTAL_INLINE RayRange range_from(double base, double speed) const {
        return {(range.least - base) * speed, (self.best_.t - base) * speed};
    }

    GRAFTAL_INLINE void set_best(double t, const Vec3& normal) {
        self.best_.t = t;
        self.best_.found = true;
        self.best_.normal = normal;
        self.best_.mesh_colour = nullptr;
        self.best_.is_upright = false;
        self.best_.in_world = false;
        self.best_.crushed = false;
    }

    GRAFTAL_INLINE void keep_way(std::uint32_t number) {
        self.way_.clear();
        for (std::uint32_t i = 1; i <= number; ++i)
            self.way_.push_back(frames[i].edge);
    }
};

} // namespace graftal
