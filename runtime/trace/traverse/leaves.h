#pragma once

// Intersections with primitives, shells, proxies and stand-ins for sets without area; only traversal.cpp
// includes this.

#include "runtime/trace/traverse/kernel.h"

namespace graftal {

template<Instructions instructions, bool any>
GRAFTAL_INLINE void
Traversal::Kernel<instructions, any>::meet_primitive(const Primitive& primitive, const Frame& parent,
                                                     const LocalRay& local, const Entry& entry) {
    const Ray ray{vec3_of(local.origin), vec3_of(local.direction)};
    RayRange near = range_from(local.base, local.speed);
    PrimitiveHit hit;
    if (!self.meet_asked(primitive, ray, near, hit)) return;
    const bool clears = model.clear_texels && !self.searches_solids();
    for (int crossing = 0;
         clears && self.is_clear(entry.entry, entry.frame, model.edges[entry.entry].turns, ray(hit.t));
         ++crossing) {
        near.least = hit.t;
        if (crossing == most_crossings || !self.meet(primitive, ray, near, hit)) return;
    }
    if (!set_best(local.base + hit.t * local.unit)) return;
    self.best_.normal = hit.normal;
    self.best_.point = ray(hit.t);
    self.best_.turns = model.edges[entry.entry].turns;
    self.best_.proxy_node = no_edge;
    compose(parent.world_from_node, model.edges[entry.entry].parent_from_child, self.best_.world_from_leaf);
    self.keep_way(entry.frame);
    self.way_.push_back(entry.entry | (parent.cut ? from_cut : 0));
}

template<Instructions instructions, bool any>
GRAFTAL_INLINE void Traversal::Kernel<instructions, any>::meet_shell(const TraceMesh& mesh,
                                                                     std::uint32_t frame_number) {
    const std::ptrdiff_t others = later.top - later.first; // they may move
    Entry entry;
    bool more = mesh.tree != no_tree && test_boxes(mesh.boxes, mesh.tree, frame_number, entry);
    while (more || pop(later.first + others, entry)) {
        more = entry.entry & BoxNode::inner &&
               test_boxes(mesh.boxes, entry.entry & ~BoxNode::inner, frame_number, entry);
        if (!more && !(entry.entry & BoxNode::inner)) meet_triangle(mesh, entry.entry, entry);
    }
}

template<Instructions instructions, bool any>
GRAFTAL_INLINE void Traversal::Kernel<instructions, any>::meet_triangle(const TraceMesh& mesh,
                                                                        std::uint32_t triangle,
                                                                        const Entry& entry) {
    ++self.visits_;
    const Frame& frame = frames[entry.frame];
    const Double4 near = frame.origin + splat(entry.at) * frame.direction;
    const double base = t_of(entry);
    PrimitiveHit hit;
    if (!intersect(mesh.triangle(triangle), {vec3_of(near), vec3_of(frame.direction)},
                   range_from(base, frame.speed), hit))
        return;
    if (!set_best(base + hit.t * frame.unit)) return;
    self.best_.normal = hit.normal;
    self.best_.world_from_leaf = frame.world_from_node;
    self.best_.proxy_node = no_edge;
    self.best_.mesh_colour = &mesh.colours[mesh.colour_of_triangle[triangle]];
    self.best_.cell = frame.scale * mesh.cell;
    self.keep_way(entry.frame);
}

template<Instructions instructions, bool any>
GRAFTAL_INLINE void
Traversal::Kernel<instructions, any>::meet_faint(const TraceNode& node, const TraceEdge& edge,
                                                 const Frame& parent, const Entry& entry) {
    const TraceNode& speck = model.nodes[parent.node];
    const Ball ball = world_ball(speck, parent, speck.ball_radius);
    if (edge.similarity) { // most are missed: a ball about it tells, as wide as any is drawn
        const Double4 middle = point_through(edge.parent_from_child, node.ball_centre);
        const double width = model.widest * model.projection.least_half_width(ball);
        const double radius = std::max(parent.scale * edge.stretch * node.ball_radius, width);
        if (passes_point(self.ray_.direction,
                         self.ray_.origin - vec3_of(point_through(parent.world_from_node, middle)), radius))
            return;
    }
    LaneMap place;
    place_child(parent, edge, place);
    if (!self.meet_leaf(node.primitive, place.affine(), true, ball, range)) return;
    self.best_.turns = edge.turns;
    self.keep_way(entry.frame);
    self.way_.push_back(entry.entry | (parent.cut ? from_cut : 0));
}

template<Instructions instructions, bool any>
GRAFTAL_INLINE void Traversal::Kernel<instructions, any>::meet_faint_proxy(const TraceNode& node,
                                                                           const Frame& frame) {
    LaneMap place;
    compose(frame.world_from_node, node.node_from_proxy, place);
    if (!self.meet_leaf(PrimitiveKind::sphere, place.affine(), true,
                        world_ball(node, frame, node.ball_radius), range))
        return;
    self.best_.proxy_node = frame.node;
    self.keep_way(static_cast<std::uint32_t>(depth - 1));
}

template<Instructions instructions, bool any>
GRAFTAL_INLINE void Traversal::Kernel<instructions, any>::meet_proxy(const TraceNode& node,
                                                                     const Frame& frame) {
    const Double4 origin = point_through(node.proxy_from_node, frame.origin);
    const Double4 direction = direction_through(node.proxy_from_node, frame.direction);
    const double largest = largest_component(direction), unit = 1 / largest;
    PrimitiveHit hit;
    if (!self.meet_asked(PrimitiveKind::sphere, {vec3_of(origin), vec3_of(direction * splat(unit))},
                         range_from(frame.base, frame.speed * largest), hit))
        return;
    if (!set_best(frame.base + hit.t * (frame.unit * unit))) return;
    self.best_.normal = hit.normal;
    self.best_.proxy_node = frame.node;
    compose(frame.world_from_node, node.node_from_proxy, self.best_.world_from_leaf);
    self.keep_way(static_cast<std::uint32_t>(depth - 1));
}

} // namespace graftal
