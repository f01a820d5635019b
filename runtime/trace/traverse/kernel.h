#pragma once

// The traversal proper, to be compiled once for each kind of instructions; only traversal.cpp includes it.

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "compiler/detail/least_width.h"
#include "runtime/trace/traverse/later_entries.h"
#include "runtime/trace/traverse/places.h"

namespace graftal {

/// `any`: the first hit ends the search, whichever it is, and its details do not count.
template<Instructions instructions, bool any> struct Traversal::Kernel : Places {
    LaterEntries later{self.later_};
    Traversal::Frame* frames = self.frames_.data(); ///< Traversal's
    std::size_t depth = 0;                          ///< frames in use

    GRAFTAL_INLINE Kernel(Traversal& traversal, const TraceModel& traced, const RayRange& asked)
        : Places{traversal, traced, asked} {}

    GRAFTAL_INLINE bool run(const Ray& ray) {
        Entry entry;
        begin(ray);
        constexpr double before_all = -std::numeric_limits<double>::infinity();
        double enough = before_all, plenty = before_all;
        if (model.most_half_width > 0) {
            enough = model.near_enough.distance(model, ray, near_enough_share);
            plenty = model.near_enough.distance(model, ray, plenty_share);
        }
        self.best_.t = range.most;
        self.visit_limit_ = self.visits_ + self.visits_allowed();
        if (!enter_world(ray)) return false;
        for (bool more = true; more || pop(later.first, entry);) {
            if (entry.entry & BoxNode::inner) {
                more = go_on_in_boxes(entry);
                continue;
            }
            more = enter(entry);
            if (any && self.best_.found) return true;
            if (self.best_.t <= plenty || (self.best_.t <= enough && self.visits_ > self.patience_)) break;
            if (self.visits_ > self.visit_limit_ && !self.goes_on()) break;
        }
        return self.best_.found;
    }

    /// Traversal::ask_operands().
    GRAFTAL_INLINE bool run(const Ray& ray, const Frame* of, const std::uint32_t* first,
                            const std::uint32_t* end, const std::uint32_t* tree) {
        begin(ray);
        Frame& frame = push();
        frame = *of;
        frame.edge = no_edge;
        ready_for_boxes(frame);
        // Single precision tells points apart no better.
        self.best_.t = self.search_ == Search::inside ? range.least + 8e-6 * frame.unit : range.most;
        Entry entry;
        // Endless ones stand in no tree, and few models have some.
        if (*tree == no_tree || model.nodes[frame.node].has_endless_operands) {
            self.boxes_ += *end - *first;
            for (std::uint32_t edge = *first; edge < *end; ++edge)
                if (*tree == no_tree || is_endless(model.nodes[model.edges[edge].child]))
                    try_edge(frames[0], edge);
        }
        bool more = *tree != no_tree && test_boxes(model.boxes, *tree, 0, entry);
        while ((more || pop(later.first, entry)) && self.visits_ <= self.visit_limit_)
            more = entry.entry & BoxNode::inner ? go_on_in_boxes(entry) : enter(entry);
        return self.best_.found;
    }

    GRAFTAL_INLINE void begin(const Ray& ray) {
        self.best_.found = false;
        self.ray_ = ray;
        self.patience_ = self.visits_ + most_patience;
        self.hurries_ = false;
        if (!self.flat_met_.empty()) self.flat_met_.clear();
    }

    /// Takes the nearest entry of those from there on, if one is left that is nearer than the best hit.
    GRAFTAL_INLINE bool pop(const Later* least, Entry& entry) {
        while (later.top > least) {
            --later.top;
            entry = entry_of(later.top->key, later.top->frame);
            if (t_of(entry) < self.best_.t) return true;
        }
        return false;
    }

    static GRAFTAL_INLINE Entry entry_of(std::int64_t key, std::uint32_t frame) {
        return {LaterEntries::at_in(key), LaterEntries::entry_in(key), frame};
    }

    GRAFTAL_INLINE double t_of(const Entry& entry) const {
        const Frame& frame = frames[entry.frame];
        return frame.base + static_cast<double>(entry.at) * frame.unit;
    }

    /// Puts the nearest of the boxes that it leads to in its place; false if there is none.
    GRAFTAL_INLINE bool go_on_in_boxes(Entry& entry) {
        depth = entry.frame + 1;
        if (entry.entry & BoxNode::packed)
            return test_packed(entry.entry & ~(BoxNode::inner | BoxNode::packed), entry.frame, entry);
        return test_boxes(model.boxes, entry.entry & ~BoxNode::inner, entry.frame, entry);
    }

    /// Puts the nearest of what it leads to in its place; false if there is nothing. An entry may be several
    /// edges, to primitives.
    GRAFTAL_INLINE bool enter(Entry& entry) {
        std::uint32_t others = 0;
        if (LeafGroup::is(entry.entry)) {
            const LeafGroup group(entry.entry);
            entry.entry = group.first;
            others = group.count - 1;
        }
        for (;; --others, ++entry.entry) {
            const bool more = enter_one(entry);
            if (others == 0 || (any && self.best_.found)) return more;
        }
    }

    GRAFTAL_INLINE Frame& push() {
        if (depth == self.frames_.size()) {
            self.frames_.resize(2 * depth);
            frames = self.frames_.data();
        }
        return frames[depth++];
    }

    /// Takes the ray to the box of the model; false if it misses that.
    GRAFTAL_INLINE bool enter_world(const Ray& ray) {
        Frame& frame = push();
        frame.world_from_node = LaneMap();
        frame.origin = lanes_of(ray.origin);
        frame.direction = lanes_of(ray.direction);
        frame.speed = power_below(largest_component(frame.direction));
        frame.unit = inverse_power(frame.speed);
        frame.direction = frame.direction * splat(frame.unit);
        frame.base = 0;
        frame.scale = 1;
        frame.edge = no_edge;
        frame.steps = model.prepared.root_steps;
        frame.cut = false;
        frame.least_detail = model.least_detail_per_unit;
        frame.items = false;
        frame.specks = false;
        frame.flatness = 1;
        frame.faint = false;
        frame.margin = Vec3(model.widest * model.most_half_width);
        ready_direction(frame);
        double at = 0;
        if (!finds(frame, model.edges.front(), at)) return false;
        frame.origin = frame.origin + splat(at) * frame.direction;
        frame.base = at * frame.unit;
        return true;
    }

    /// Where boxes are few or infinite: in double precision; false if the edge's is not met, else from where
    /// on.
    GRAFTAL_INLINE bool finds(const Frame& frame, const TraceEdge& edge, double& at) const {
        at = (range.least - frame.base) * frame.speed;
        if (is_endless(model.nodes[edge.child])) return true;
        const RayRange within{at, (self.best_.t - frame.base) * frame.speed};
        const Ray ray{vec3_of(frame.origin), vec3_of(frame.direction)};
        const RayRange inside = range_in(enlarged(edge.box, frame.margin), ray, within);
        at = inside.least;
        return inside.least <= inside.most;
    }

    GRAFTAL_INLINE void try_edge(const Frame& frame, std::uint32_t number) {
        double at = 0;
        if (!finds(frame, model.edges[number], at)) return;
        later.reserve();
        *later.top++ = {LaterEntries::key_of(float_below(at), number), static_cast<std::uint32_t>(depth - 1)};
    }

    GRAFTAL_INLINE bool test_boxes(const std::vector<BoxNode>& boxes, std::uint32_t number,
                                   std::uint32_t frame_number, Entry& nearest) {
        const BoxNode& node = boxes[number];
        const auto side_of = [&](std::size_t side, int axis)
                                 GRAFTAL_INLINED_LAMBDA { return node.side[side][axis]; };
        return test_lanes(
            side_of, [&](std::size_t lane) { return node.entry[lane]; }, ~0u, frame_number, nearest);
    }

    GRAFTAL_INLINE bool test_packed(std::uint32_t number, std::uint32_t frame_number, Entry& nearest) {
        const PackedNode& node = model.packed_boxes[number];
        const auto side_of = [&](std::size_t side, int axis) GRAFTAL_INLINED_LAMBDA {
            const auto i = static_cast<std::size_t>(axis);
            Byte8 bytes;
            std::memcpy(&bytes, node.side[side][i].data(), sizeof(bytes));
            return spread<instructions>(node.origin[i]) +
                   __builtin_convertvector(bytes, Float8) * spread<instructions>(node.step[i]);
        };
        return test_lanes(
            side_of, [&](std::size_t lane) { return node.first + node.offset[lane]; }, (1u << node.count) - 1,
            frame_number, nearest);
    }

    /// Sorts the boxes that the ray meets: the nearest one becomes `nearest`, the others go onto the stack,
    /// the farthest first. False if there is none. `used`: the lanes that hold boxes, others may.
    template<typename SideOf, typename EntryOf>
    GRAFTAL_INLINE bool test_lanes(const SideOf& side_of, const EntryOf& number_of, std::uint32_t used,
                                   std::uint32_t frame_number, Entry& nearest) {
        self.boxes_ += RayWork::boxes;
        const Frame& frame = frames[frame_number];
        // A little more, for what single precision leaves out.
        const float most = static_cast<float>((self.best_.t - frame.base) * frame.speed) + 2e-6f;
        Float8 enters = spread<instructions>(frame.least), leaves = spread<instructions>(most);
        for (int axis = 0; axis < 3; ++axis) {
            const auto in = static_cast<std::size_t>(frame.side_in[axis]);
            const Float8 reciprocal = spread<instructions>(frame.reciprocal[axis]);
            // Lanes of no numbers stay so by the last axis.
            enters = greater(enters,
                             (side_of(in, axis) - spread<instructions>(frame.origin_in[axis])) * reciprocal);
            leaves = lesser(leaves, (side_of(1 - in, axis) - spread<instructions>(frame.origin_out[axis])) *
                                        reciprocal);
        }
        std::uint32_t lanes = bits_of<instructions>(enters <= leaves) & used;
        if (lanes == 0) return false;
        const std::int64_t key =
            later.nearest_of(lanes, frame_number, [&](std::uint32_t bits) GRAFTAL_INLINED_LAMBDA {
                const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
                return LaterEntries::key_of(enters[lane], number_of(lane));
            });
        nearest = entry_of(key, frame_number);
        return true;
    }

    GRAFTAL_INLINE bool enter_one(Entry& entry) {
        ++self.visits_;
        if (frames[entry.frame].items) {
            meet_item(entry);
            return false;
        }
        depth = entry.frame + 1;
        const TraceEdge& edge = model.edges[entry.entry];
        const TraceNode& node = model.nodes[edge.child];
        double flatness = frames[entry.frame].flatness;
        if (!edge.similarity) {
            self.more_work_ += RayWork::stretched;
            flatness *= edge.flatness;
            if (!(flatness > flattest_placement)) { // the product of many flat maps need not be flat
                self.more_work_ += RayWork::doubted;
                flatness = self.placed_flatness(frames[entry.frame].world_from_node, edge);
            }
            if (!(flatness > flattest_placement)) {
                if (!self.searches_solids()) self.meet_flat(entry.frame, entry.entry, range, any);
                return false;
            }
        }
        LocalRay ray;
        if (frames[entry.frame].specks && node.speck_count > 0 && !self.searches_solids()) {
            const Frame& parent = frames[entry.frame];
            if (!take_ray(edge, parent, entry, ray) ||
                misses_specks(node, ray, parent.margin.x * edge.growth))
                return false;
        }
        if (node.kind == TraceNode::Kind::primitive) {
            const Frame& parent = frames[entry.frame];
            if (parent.faint && node.primitive != PrimitiveKind::plane && !self.searches_solids())
                meet_faint(node, edge, parent, entry);
            else if (take_ray(edge, parent, entry, ray))
                meet_primitive(node.primitive, parent, ray, entry);
            return false;
        }
        Frame& frame = push(); // parents may move, but no more after this
        const Frame& parent = frames[entry.frame];
        if (!take_ray(edge, parent, entry, frame)) return false;
        if (edge.upright) {
            frame.reciprocal = parent.reciprocal;
            frame.side_in = parent.side_in;
        } else {
            ready_direction(frame);
        }
        frame.flatness = flatness;
        return enter_node(edge, node, parent, frame, entry);
    }

    /// Takes the ray into the frame of an edge's child, from where the entry begins; false if that is no map.
    GRAFTAL_INLINE bool take_ray(const TraceEdge& edge, const Frame& parent, const Entry& entry,
                                 LocalRay& ray) const {
        const Double4 near = parent.origin + splat(entry.at) * parent.direction;
        ray.base = parent.base + entry.at * parent.unit;
        if (edge.upright) {
            const double growth = edge.child_from_parent.column[0][0];
            ray.origin = near * splat(growth) + edge.child_from_parent.translation;
            ray.direction = parent.direction;
            ray.speed = parent.speed * edge.growth;
            ray.unit = parent.unit * edge.stretch;
            return true;
        }
        const Double4 direction = direction_through(edge.child_from_parent, parent.direction);
        ray.origin = point_through(edge.child_from_parent, near);
        if (edge.similarity) {
            // The direction grows as much as the map shrinks; to compute its length anew would take longer.
            ray.direction = direction * splat(edge.stretch);
            ray.speed = parent.speed * edge.growth;
            ray.unit = parent.unit * edge.stretch;
            return true;
        }
        const double largest = largest_component(direction);
        if (!(largest > 0 && largest < 1 / least_scale)) return false;
        const double shrink = 1 / largest;
        ray.direction = direction * splat(shrink);
        ray.speed = parent.speed * largest;
        ray.unit = parent.unit * shrink;
        return true;
    }

    /// The frame has its ray.
    GRAFTAL_INLINE bool enter_node(const TraceEdge& edge, const TraceNode& node, const Frame& parent,
                                   Frame& frame, Entry& entry) {
        if (!go_to_child(edge, node, entry.entry, parent, frame)) return false;
        // Operands need no tree.
        const bool has_operands = node.kind == TraceNode::Kind::combined && node.stop_edge_count > 0;
        if (frame.cut && node.stop_tree == no_tree && !has_operands) {
            if ((frame.faint || node.faint) && !self.searches_solids())
                meet_faint_proxy(node, frame);
            else
                meet_proxy(node, frame);
            return false;
        }
        const auto number = static_cast<std::uint32_t>(depth - 1);
        frame.margin = margin_of(node, frame);
        if (node.kind == TraceNode::Kind::unbounded) {
            const bool is_near = node.tree != no_tree && go_to_bounded(node, frame);
            for (std::uint32_t i = 0; i < node.endless_count; ++i)
                try_edge(frame, node.first_edge + i);
            if (!is_near) return false;
            ready_for_boxes(frame);
            return test_boxes(model.boxes, node.tree, number, entry);
        }
        if (node.kind == TraceNode::Kind::combined && !(frame.cut && !node.stops_combined)) {
            self.meet_combined(number, range);
            return false;
        }
        if (node.kind == TraceNode::Kind::crushed) {
            for (std::uint32_t i = 0; i < node.edge_count && !self.searches_solids(); ++i)
                self.meet_flat(number, node.first_edge + i, range, any);
            return false;
        }
        if (is_shell(node, frame)) {
            frame.margin = Vec3(shell_margin(node, frame));
            ready_for_boxes(frame);
            meet_shell(self.shell_of(frame), number);
            return false;
        }
        if (frame.cut && frame.faint && node.speck_count > 0 && frame.flatness == 1 &&
            !self.searches_solids()) {
            meet_specks(node, number);
            return false;
        }
        ready_for_boxes(frame);
        if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            entry = {0, node.first_edge + node.edge_count, number};
            return true;
        }
        const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame);
        if (tree == no_tree) return false;
        if (frame.items && !frame.cut && (tree & BoxNode::packed))
            return test_packed(tree & ~BoxNode::packed, number, entry);
        return test_boxes(model.boxes, tree, number, entry);
    }

    /// Takes the ray to what is bounded of an unbounded union, so that single precision does for its boxes;
    /// false, and nothing done, if it misses that.
    GRAFTAL_INLINE bool go_to_bounded(const TraceNode& node, Frame& frame) const {
        const Box about{Vec3(-node.drawn_radius), Vec3(node.drawn_radius)};
        const Ray ray{vec3_of(frame.origin), vec3_of(frame.direction)};
        const RayRange inside =
            range_in(enlarged(about, frame.margin), ray, range_from(frame.base, frame.speed));
        if (!(inside.least <= inside.most)) return false;
        frame.origin = frame.origin + splat(inside.least) * frame.direction;
        frame.base += inside.least * frame.unit;
        return true;
    }

    GRAFTAL_INLINE void ready_direction(Frame& frame) const {
        const Float4 direction = __builtin_convertvector(frame.direction, Float4);
        frame.reciprocal = 1 / never_zero(direction);
        frame.side_in = -(frame.reciprocal < 0);
    }

    /// The frame has its ray, that its direction, and its margin.
    GRAFTAL_INLINE void ready_for_boxes(Frame& frame) const {
        frame.least = static_cast<float>((range.least - frame.base) * frame.speed);
        const Float4 origin = __builtin_convertvector(frame.origin, Float4);
        const Float4 margin = {static_cast<float>(frame.margin.x), static_cast<float>(frame.margin.y),
                               static_cast<float>(frame.margin.z), 0};
        const Float4 inwards = frame.side_in != 0 ? -margin : margin;
        frame.origin_in = origin + inwards;
        frame.origin_out = origin - inwards;
    }

    /// Range of a ray that starts there.
    GRAFTAL_INLINE RayRange range_from(double base, double speed) const {
        return {(range.least - base) * speed, (self.best_.t - base) * speed};
    }

    /// False if nobody asks for more.
    GRAFTAL_INLINE bool set_best(double t) {
        if (self.search_ == Search::inside) {
            if (!(t > self.leaves_)) return false;
            self.leaves_ = t;
        } else {
            self.best_.t = t;
        }
        self.best_.renew();
        return !any;
    }

    /// Meets an item of the frame's run (runs.h).
    void meet_item(const Entry& entry);
    /// `ray`: from where the entry begins, in units of the frame's.
    void meet_body(RunShape shape, const Affine& run_from_body, const TraceRun& run, std::uint16_t colour,
                   const Ray& ray, const Entry& entry);

    // Intersections (leaves.h):
    void meet_primitive(const Primitive& primitive, const Frame& parent, const LocalRay& local,
                        const Entry& entry);
    void meet_shell(const TraceMesh& mesh, std::uint32_t frame_number);
    void meet_triangle(const TraceMesh& mesh, std::uint32_t triangle, const Entry& entry);
    /// Specks of a node that the ray in its frame may meet, as bits; `half_width`: by TraceModel::widest.
    std::uint32_t specks_near(const SpeckLanes& specks, const LocalRay& ray, double half_width) const;
    bool misses_specks(const TraceNode& node, const LocalRay& ray, double half_width) const;
    void meet_specks(const TraceNode& node, std::uint32_t frame_number);
    /// A primitive of what stands for a set without area.
    void meet_faint(const TraceNode& node, const TraceEdge& edge, const Frame& parent, const Entry& entry);
    void meet_faint_proxy(const TraceNode& node, const Frame& frame);
    /// Meets the stand-in of the frame's own node.
    void meet_proxy(const TraceNode& node, const Frame& frame);
};

} // namespace graftal
