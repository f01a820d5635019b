#pragma once

// How rays go through models whose parts are only scaled evenly and moved, and drawn no wider than they are:
// the general way (traversal_kernel.h) without what such models never ask for, with the same bits where that
// has no margins. Of world_from_node a frame keeps the translation, and its scale in the first entry alone.
// Only traversal.cpp includes this.

#include "runtime/trace/traversal_kernel.h"

namespace graftal {

template<Instructions instructions, bool any, bool even>
GRAFTAL_INLINE void Traversal::Kernel<instructions, any, even>::place_leaf(const Frame& parent,
                                                                           const LaneMap& parent_from_leaf,
                                                                           LaneMap& world_from_leaf) const {
    if constexpr (even) {
        const Double4 scale = splat(even_scale(parent));
        for (int i = 0; i < 3; ++i)
            world_from_leaf.column[i] = scale * parent_from_leaf.column[i];
        world_from_leaf.translation =
            scale * parent_from_leaf.translation + parent.world_from_node.translation;
    } else {
        compose(parent.world_from_node, parent_from_leaf, world_from_leaf);
    }
}

template<Instructions instructions, bool any, bool even>
GRAFTAL_INLINE bool Traversal::Kernel<instructions, any, even>::enter_world(const Ray& ray, Entry& entry) {
    Frame& frame = push_ray(ray);
    const RayRange within{(range.least - frame.base) * frame.speed,
                          (self.best_.t - frame.base) * frame.speed};
    const RayRange inside = range_in(enlarged(model.edges.front().box, Vec3(0.0)),
                                     {vec3_of(frame.origin), vec3_of(frame.direction)}, within);
    if (!(inside.least <= inside.most)) return false;
    ready_direction(frame);
    entry = {inside.least, 0, 0};
    return true;
}

template<Instructions instructions, bool any, bool even>
GRAFTAL_INLINE bool Traversal::Kernel<instructions, any, even>::enter_even(Entry& entry) {
    ++self.visits_;
    self.depth_ = entry.frame + 1;
    const TraceEdge& edge = model.edges[entry.entry];
    const TraceNode& node = model.nodes[edge.child];
    if (edge.to_primitive) {
        if (!edge.similarity) self.more_work_ += RayWork::stretched;
        const Frame& parent = self.frames_[entry.frame];
        LocalRay ray;
        if (take_ray(edge, parent, entry, ray)) meet_primitive(node.primitive, parent, ray, entry);
        return false;
    }
    Frame& frame = push(); // parents may move, but no more after this
    const Frame& parent = self.frames_[entry.frame];
    const Double4 near = parent.origin + splat(entry.at) * parent.direction;
    const double growth = edge.child_from_parent.column[0][0];
    frame.base = parent.base + entry.at * parent.unit;
    frame.origin = near * splat(growth) + edge.child_from_parent.translation;
    frame.speed = parent.speed * edge.growth;
    frame.unit = parent.unit * edge.stretch;
    if (edge.keeps_directions) {
        frame.direction = parent.direction;
        frame.reciprocal = parent.reciprocal;
        frame.side_in = parent.side_in;
    } else {
        frame.direction = parent.direction * splat(growth) * splat(edge.stretch);
        ready_direction(frame);
    }
    frame.world_from_node.translation =
        splat(even_scale(parent)) * edge.parent_from_child.translation + parent.world_from_node.translation;
    frame.world_from_node.column[0][0] = even_scale(parent) * edge.parent_from_child.column[0][0];
    frame.edge = entry.entry | (parent.cut ? from_cut : 0);
    frame.node = edge.child;
    frame.steps = parent.steps == unlimited_steps ? parent.steps : parent.steps - edge.levels;
    frame.scale = parent.scale * edge.stretch;
    if (!(frame.scale > least_scale)) return false;
    double detail = INFINITY;
    frame.cut = is_cut(node, frame, parent.least_detail, detail);
    frame.least_detail = model.least_detail_per_unit;
    if (frame.cut && node.stop_tree == no_tree) {
        if (node.faint)
            meet_faint_proxy(node, frame);
        else
            meet_proxy(node, frame);
        return false;
    }
    frame.least = static_cast<float>((range.least - frame.base) * frame.speed);
    frame.origin_in = __builtin_convertvector(frame.origin, Float4); // and out
    const auto number = static_cast<std::uint32_t>(self.depth_ - 1);
    if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
        entry = {0, node.first_edge + node.edge_count, number};
        return true;
    }
    const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame);
    return tree != no_tree && test_boxes(model.boxes, tree, number, entry);
}

} // namespace graftal
