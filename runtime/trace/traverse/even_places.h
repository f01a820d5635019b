#pragma once

// Choice of the parts of an even model that rays look into, and the parts' places in the world. Neither
// depends on the rays. Only traversal.cpp and packets.cpp include this.

#include "runtime/trace/model/even_parts.h"
#include "runtime/trace/traverse/kernel.h"

namespace graftal {

struct Traversal::EvenPlaces {
    Traversal& self;
    const TraceModel& model;
    const RayRange range;
    const bool culls = model.projection.culls();

    GRAFTAL_INLINE Ball world_ball(const TraceNode& node, const EvenPlace& frame, double radius) const {
        return {vec3_of(node.ball_centre * splat(frame.entry) + frame.offset), frame.scale * radius};
    }

    /// Places::is_cut() for even models.
    GRAFTAL_INLINE bool is_cut(const TraceNode& node, const EvenPlace& frame, double least_detail) const {
        if (self.hurries_ && node.cullable) return true;
        double detail = INFINITY;
        if (node.cullable && !(2 * frame.scale * node.ball_radius * least_detail > node.cut_detail)) {
            const Ball ball = world_ball(node, frame, node.ball_radius);
            detail = 2 * ball.radius * model.projection.detail_per_unit(ball);
        }
        return graftal::is_cut(node, frame.steps, detail);
    }

    /// Places::tree_of() for even models. Where the node's reach is within its parent's, the parent's detail
    /// often decides.
    GRAFTAL_INLINE std::uint32_t tree_of(const TraceNode& node, EvenPlace& frame, const EvenPart& part,
                                         const EvenPlace& parent) const {
        if (part.within) {
            frame.least_detail = parent.least_detail;
            frame.most_detail = parent.most_detail;
        }
        bool known = false;
        for (std::uint32_t i = 0; i < node.unrolling_count; ++i) {
            const Unrolling& unrolling = model.unrollings[node.first_unrolling + i];
            if (frame.steps < unrolling.least_steps) continue;
            const double size = frame.scale * unrolling.least_size;
            const bool has_leaves = unrolling.leaf_tree != no_tree;
            if (has_leaves && frame.steps == unrolling.last_steps) return unrolling.leaf_tree;
            const double largest = frame.scale * unrolling.most_size;
            if (!known) {
                const bool told = !has_leaves || largest * frame.most_detail <= surely_more ||
                                  largest * frame.least_detail > 1;
                if (!told || !(size * frame.least_detail > 1)) {
                    const auto details = model.projection.detail_range(world_ball(node, frame, node.reach));
                    frame.least_detail = surely_more * details.least;
                    frame.most_detail = details.most;
                    known = true;
                }
            }
            if (!(size * frame.least_detail > 1)) continue;
            const bool all_cut = has_leaves && largest * frame.most_detail <= surely_more;
            return all_cut ? unrolling.leaf_tree : unrolling.tree;
        }
        return node.tree;
    }

    /// Goes to the child of an edge; false if it is nothing.
    GRAFTAL_INLINE bool go_to_child(const EvenPart& part, std::uint32_t edge, const EvenPlace& parent,
                                    EvenPlace& child) const {
        place_child(edge, parent, child);
        step_to_child(part, edge, parent, child);
        if (!(child.scale > least_scale)) return false;
        child.cut = is_cut(model.nodes[part.child], child, parent.least_detail);
        return true;
    }

    GRAFTAL_INLINE void place_child(std::uint32_t edge, const EvenPlace& parent, EvenPlace& child) const {
        const Double4 offset = model.even_offsets[edge].offset;
        child.offset = splat(parent.entry) * offset + parent.offset;
        child.entry = parent.entry * offset[3];
    }

    /// Sets all of the child except its place in the world and whether it is cut.
    GRAFTAL_INLINE void step_to_child(const EvenPart& part, std::uint32_t edge, const EvenPlace& parent,
                                      EvenPlace& child) const {
        child.scale = parent.scale * part.stretch;
        child.edge = edge | (parent.cut ? from_cut : 0);
        child.node = part.child;
        child.steps = steps_below(parent.steps, part);
        child.least_detail = model.least_detail_per_unit;
        child.most_detail = INFINITY;
    }

    GRAFTAL_INLINE void place_world(EvenPlace& world) const {
        world.offset = Double4{};
        world.entry = world.scale = 1;
        world.steps = model.prepared.root_steps;
        world.cut = false;
        world.least_detail = model.least_detail_per_unit;
        world.most_detail = INFINITY;
    }

    /// Rays begin there, all alike.
    void find_root() const {
        const EvenPart& part = model.even_parts.front();
        if (part.kind != EvenPart::Kind::node) return;
        EvenPlace world;
        EvenRoot& root = self.even_root_;
        place_world(world);
        if (!go_to_child(part, 0, world, root.place) || root.place.cut) return;
        root.tree = tree_of(model.nodes[part.child], root.place, part, world);
    }

    /// Tree of boxes to look into, where nothing is culled: the node and the levels left decide. no_tree:
    /// the node needs a closer look.
    GRAFTAL_INLINE std::uint32_t known_tree(const EvenPart& part, EvenPlace& frame) const {
        const std::uint32_t number = part.child;
        EvenTree& known = self.even_trees_[(7 * number + frame.steps) % self.even_trees_.size()];
        if (known.node != number || known.steps != frame.steps) find_tree(part, frame, known);
        frame.cut = known.cut;
        return known.tree;
    }

    GRAFTAL_INLINE void find_tree(const EvenPart& part, const EvenPlace& frame, EvenTree& known) const {
        const TraceNode& node = model.nodes[part.child];
        EvenPlace place = frame;
        place.cut = graftal::is_cut(node, frame.steps, INFINITY);
        known = {part.child, frame.steps, no_tree, place.cut};
        if (place.cut && node.stop_edge_count == 1) return;
        known.tree = place.cut ? node.stop_tree : tree_of(node, place, part, place);
    }

    /// Fetches the look of the edge to a leaf that was met: it is needed if nothing nearer is met.
    GRAFTAL_INLINE void prefetch_look(std::uint32_t number) const {
        __builtin_prefetch(&model.looks[number]);
    }

    GRAFTAL_INLINE void place(const EvenPlace& parent, const LaneMap& parent_from_leaf,
                              LaneMap& world_from_leaf) const {
        for (int i = 0; i < 3; ++i)
            world_from_leaf.column[i] = splat(parent.entry) * parent_from_leaf.column[i];
        world_from_leaf.translation = splat(parent.entry) * parent_from_leaf.translation + parent.offset;
    }
};

} // namespace graftal
