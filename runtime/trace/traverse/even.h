#pragma once

// Traversal of models whose parts are only scaled evenly and moved, and drawn no wider than they are: the
// general way (kernel.h) without what such models never need. The ray has one direction in all
// frames; a frame's place is a scale and an offset. Only traversal.cpp and packets.cpp include it.

#include "compiler/primitives/passage.h"
#include "runtime/trace/traverse/even_places.h"
#include "runtime/trace/traverse/later_entries.h"
#include "runtime/trace/traverse/packet_room.h"

namespace graftal {

template<Instructions instructions, bool any> struct Traversal::EvenKernel : EvenPlaces {
    using Frame = EvenFrame;

    Frame* frames; ///< Traversal's
    LaterEntries later;
    std::uint32_t first_placed = 0; ///< from there down frames know where they lie in the world
    // In every frame:
    Double4 direction, inverse;
    bool is_parallel;     ///< to some of a cube's faces
    Float8 reciprocal[3]; ///< of the direction, never infinite
    /// Sides of boxes where the ray goes in and out, as a node has them one after the other.
    std::size_t in[3], out[3];

    GRAFTAL_INLINE explicit EvenKernel(Traversal& traversal, const TraceModel& traced, const RayRange& asked)
        : EvenPlaces{traversal, traced, asked}, frames(self.even_frames_.data()), later{self.later_} {}

    GRAFTAL_INLINE bool run(const Ray& ray) {
        self.best_.found = false;
        self.best_.t = range.most;
        self.ray_ = ray;
        self.visit_limit_ = self.visits_ + self.visits_allowed();
        self.hurries_ = false;
        if (!enter_world(ray)) return false;
        if (self.even_root_.tree == no_tree) return go_on({});
        std::int64_t key = 0;
        return enter_root(key) && go_on({LaterEntries::at_in(key), LaterEntries::entry_in(key), 1});
    }

    /// From an entry on, until nothing is left; true if something nearer was met.
    GRAFTAL_INLINE bool go_on(const Entry& first) {
        std::int64_t key = LaterEntries::key_of(first.at, first.entry);
        std::uint32_t frame = first.frame;
        for (bool more = true; more || pop(key, frame);) {
            if (LaterEntries::entry_in(key) & BoxNode::inner) {
                more = test_boxes(LaterEntries::entry_in(key) & ~BoxNode::inner, frame, key);
                continue;
            }
            more = enter(key, frame);
            if (any && self.best_.found) return true;
            if (self.visits_ > self.visit_limit_ && !self.goes_on()) break;
        }
        return self.best_.found;
    }

    /// Takes the nearest entry, if one is left that is nearer than the best hit.
    GRAFTAL_INLINE bool pop(std::int64_t& key, std::uint32_t& number) {
        while (later.top != later.first) {
            --later.top;
            key = later.top->key;
            number = later.top->frame;
            const Frame& frame = frames[number];
            if (frame.base + static_cast<double>(LaterEntries::at_in(key)) * frame.unit < self.best_.t)
                return true;
        }
        return false;
    }

    GRAFTAL_INLINE bool enter_world(const Ray& ray) {
        Frame& frame = frames[0];
        const Double4 origin = lanes_of(ray.origin);
        direction = lanes_of(ray.direction);
        frame.speed = power_below(largest_component(direction));
        frame.unit = inverse_power(frame.speed);
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
        place_world(frame);
        const Float4 divisor = never_zero(__builtin_convertvector(direction, Float4));
        const Float4 quotient = 1 / divisor;
        std::size_t sides[3];
        for (int axis = 0; axis < 3; ++axis) {
            reciprocal[axis] = spread<instructions>(quotient[axis]);
            sides[axis] = quotient[axis] < 0 ? 1 : 0;
        }
        set_sides(sides);
        return true;
    }

    GRAFTAL_INLINE void set_sides(const std::size_t (&side_in)[3]) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            in[axis] = 3 * side_in[axis] + axis;
            out[axis] = 3 * (1 - side_in[axis]) + axis;
        }
    }

    /// range_in() for a ray that is parallel to no side.
    GRAFTAL_INLINE RayRange range_between(const Box& box, const Double4& origin, RayRange within) const {
        const Double4 a = (lanes_of(box.min) - origin) * inverse, b = (lanes_of(box.max) - origin) * inverse;
        const Double4 enter = b < a ? b : a, leave = a < b ? b : a;
        for (int axis = 0; axis < 3; ++axis) {
            const double from = enter[axis], to = leave[axis];
            within.least = within.least < from ? from : within.least;
            within.most = to < within.most ? to : within.most;
        }
        return within;
    }

    /// Sides of all boxes of a node.
    static GRAFTAL_INLINE const Float8& sides_at(const BoxNode& node, std::size_t number) {
        return *(&node.side[0][0] + number);
    }

    /// Puts the nearest of the boxes that the ray meets in the place of their node, and keeps the others, the
    /// farthest first; false if there is none.
    GRAFTAL_INLINE bool test_boxes(std::uint32_t number, std::uint32_t frame_number, std::int64_t& nearest) {
        self.boxes_ += RayWork::boxes;
        const BoxNode& node = model.boxes[number];
        const Frame& frame = frames[frame_number];
        // A little more, for what single precision leaves out.
        const float most = static_cast<float>((self.best_.t - frame.base) * frame.speed) + 2e-6f;
        Float8 enters = spread<instructions>(frame.least), leaves = spread<instructions>(most);
        for (int axis = 0; axis < 3; ++axis) {
            const Float8 origin = spread<instructions>(frame.near[axis]);
            // Lanes of no numbers stay so by the last axis.
            enters = greater(enters, (sides_at(node, in[axis]) - origin) * reciprocal[axis]);
            leaves = lesser(leaves, (sides_at(node, out[axis]) - origin) * reciprocal[axis]);
        }
        std::uint32_t met = bits_of<instructions>(enters <= leaves);
        if (met == 0) return false;
        nearest = later.nearest_of(met, frame_number, [&](std::uint32_t bits) GRAFTAL_INLINED_LAMBDA {
            const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
            return LaterEntries::key_of(enters[lane], node.entry[lane]);
        });
        return true;
    }

    /// Enters a root of which it is known what is in it, as any other part.
    GRAFTAL_INLINE bool enter_root(std::int64_t& nearest) {
        ++self.visits_;
        Frame& frame = frames[1];
        static_cast<EvenPlace&>(frame) = self.even_root_.place;
        take_ray(model.even_parts.front(), frames[0], 0, frame);
        return test_boxes(self.even_root_.tree, 1, nearest);
    }

    GRAFTAL_INLINE void take_ray(const EvenPart& part, const Frame& parent, double at, Frame& frame) const {
        frame.base = parent.base + at * parent.unit;
        frame.speed = parent.speed * part.growth;
        frame.unit = parent.unit * part.stretch;
        frame.origin = (parent.origin + splat(at) * direction) * splat(part.shrink()) + part.shift;
        frame.least = static_cast<float>((range.least - frame.base) * frame.speed);
        frame.near = __builtin_convertvector(frame.origin, Float4);
    }

    /// Puts the nearest of what an entry leads to in its place, and the frame of that; false if there is
    /// nothing.
    GRAFTAL_INLINE bool enter(std::int64_t& key, std::uint32_t& number) {
        ++self.visits_;
        const std::uint32_t edge = LaterEntries::entry_in(key);
        if (LeafGroup::is(edge)) {
            meet_triangles(LeafGroup(edge), frames[number], LaterEntries::at_in(key), number);
            return false;
        }
        const EvenPart& part = model.even_parts[edge];
        if (part.kind != EvenPart::Kind::node) {
            meet_leaf(part, frames[number], {LaterEntries::at_in(key), edge, number});
            return false;
        }
        ++number;
        if (number == self.even_frames_.size()) {
            self.even_frames_.resize(2 * number);
            frames = self.even_frames_.data();
        }
        const Frame& parent = frames[number - 1];
        Frame& frame = frames[number];
        take_ray(part, parent, LaterEntries::at_in(key), frame);
        if (!culls) {
            step_to_child(part, edge, parent, frame);
            if (!(frame.scale > least_scale)) return false;
            const std::uint32_t tree = self.hurries_ ? no_tree : known_tree(part, frame);
            if (tree != no_tree) return test_boxes(tree, number, key);
            frame.cut = is_cut(model.nodes[part.child], frame, INFINITY);
        } else if (!go_to_child(part, edge, parent, frame)) {
            return false;
        }
        const TraceNode& node = model.nodes[part.child];
        if (frame.cut && node.stop_tree == no_tree) {
            place_frames(number);
            meet_proxy(node, frame, number);
            return false;
        }
        if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            key = LaterEntries::key_of(0, node.first_edge + node.edge_count);
            return true;
        }
        const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame, part, parent);
        key = LaterEntries::key_of(0, tree | BoxNode::inner);
        return tree != no_tree;
    }

    /// Fills in where frames lie in the world, where nobody asked so far.
    GRAFTAL_INLINE void place_frames(std::uint32_t number) {
        if (culls) return;
        for (std::uint32_t i = first_placed + 1; i <= number; ++i)
            place_child(frames[i].edge & ~from_cut, frames[i - 1], frames[i]);
    }

    GRAFTAL_INLINE void meet_leaf(const EvenPart& part, const Frame& parent, const Entry& entry) {
        const double at = entry.at, base = parent.base + at * parent.unit;
        const Double4 near = parent.origin + splat(at) * direction;
        PrimitiveHit hit;
        Vec3 origin, along;
        double unit;
        if (part.kind == EvenPart::Kind::cube && !is_parallel) {
            origin = vec3_of(near * splat(part.shrink()) + part.shift);
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
            origin = vec3_of(edge.upright ? near * splat(part.shrink()) + part.shift
                                          : point_through(edge.child_from_parent, near));
            along = vec3_of(edge.upright ? direction : turned * splat(shrink));
            unit = parent.unit * shrink;
            const RayRange near_range = range_from(base, parent.speed * largest);
            if (part.kind == EvenPart::Kind::triangle) {
                if (!meet_triangle({origin, along}, near_range, hit)) return;
            } else if (!self.meet(model.nodes[part.child].primitive, {origin, along}, near_range, hit)) {
                return;
            }
        }
        set_best(base + hit.t * unit, hit.normal);
        if (any) return;
        keep_leaf(part, entry.entry, parent, entry.frame, origin + hit.t * along);
    }

    /// Keeps the best hit: the child of the edge, met at a point in its frame.
    GRAFTAL_INLINE void keep_leaf(const EvenPart& part, std::uint32_t edge, const Frame& parent,
                                  std::uint32_t number, const Vec3& point) {
        prefetch_look(edge);
        if (self.packet_->has_textures) {
            self.best_.point = point;
            self.best_.turns = model.edges[edge].turns;
        }
        self.best_.proxy_node = no_edge;
        self.best_.is_upright = part.upright && !self.packet_->has_patterns;
        if (!self.best_.is_upright) {
            place_frames(number);
            place(parent, model.edges[edge].parent_from_child, self.best_.world_from_leaf);
        }
        keep_way(number);
        self.way_.push_back(edge | (parent.cut ? from_cut : 0));
    }

    /// Each as meet_leaf() would meet it, one after the other.
    GRAFTAL_INLINE void meet_triangles(const LeafGroup& group, const Frame& parent, double at,
                                       std::uint32_t number) {
        self.visits_ += group.count - 1;
        const EvenTriangles& all = model.even_triangles[model.even_parts[group.first].group];
        if (!all.similar) self.more_work_ += RayWork::stretched * group.count;
        const double base = parent.base + at * parent.unit;
        const Double4 near = parent.origin + splat(at) * direction;
        const auto along = [&](const Double4* row) GRAFTAL_INLINED_LAMBDA {
            return row[0] * splat(direction[0]) + row[1] * splat(direction[1]) + row[2] * splat(direction[2]);
        };
        const auto place = [&](const Double4* row) GRAFTAL_INLINED_LAMBDA {
            return row[0] * splat(near[0]) + row[1] * splat(near[1]) + row[2] * splat(near[2]) + row[3];
        };
        const Double4 dx = along(all.row[1]), dy = along(all.row[2]), dz = along(all.row[0]);
        Double4 growth = all.growth, stretch = all.stretch;
        if (!all.similar) {
            growth = largest_of(dx, dy, dz);
            stretch = 1 / growth;
        }
        const Double4 from_plane = place(all.row[0]);
        const Double4 t = -from_plane / (dz * stretch);
        const Double4 speed = parent.speed * growth;
        const Long4 ahead = (growth > splat(0.0)) & (growth < splat(1 / least_scale)) &
                            (t > (range.least - base) * speed) & (t < (self.best_.t - base) * speed);
        const std::uint32_t used = (1u << group.count) - 1;
        if ((bits_of<instructions>(ahead) & used) == 0) return;
        constexpr double root3 = 1.7320508075688772;
        const Double4 x = place(all.row[1]) + t * (dx * stretch), y = place(all.row[2]) + t * (dy * stretch);
        std::uint32_t met =
            used & bits_of<instructions>(ahead & (y >= splat(-0.5 - passage_rounding)) &
                                         (root3 * size_of(x) + y <= splat(1 + passage_rounding)));
        const Double4 in_world = base + t * (parent.unit * stretch);
        for (; met != 0; met &= met - 1) {
            const int lane = std::countr_zero(met);
            if (!(t[lane] < (self.best_.t - base) * speed[lane])) continue;
            set_best(in_world[lane], {0, 0, 1});
            if (any) return;
            const std::uint32_t edge = group.first + static_cast<std::uint32_t>(lane);
            keep_leaf(model.even_parts[edge], edge, parent, number,
                      {x[lane], y[lane], from_plane[lane] + t[lane] * (dz[lane] * stretch[lane])});
        }
    }

    /// Meets a cube by the operations of the primitive (cube.cpp).
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

    /// Meets the stand-in of the frame's own node.
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
        self.best_.renew();
        self.best_.t = t;
        self.best_.normal = normal;
    }

    GRAFTAL_INLINE void keep_way(std::uint32_t number) {
        self.way_.resize(number);
        for (std::uint32_t i = 1; i <= number; ++i)
            self.way_[i - 1] = frames[i].edge;
    }
};

} // namespace graftal
