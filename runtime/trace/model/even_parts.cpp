#include "runtime/trace/model/even_parts.h"

#include <glm/geometric.hpp>

#include "runtime/trace/model/trace_model.h"

namespace graftal {

namespace {

EvenPart::Kind kind_of(const TraceModel& model, const TraceEdge& edge) {
    if (!edge.to_primitive) return EvenPart::Kind::node;
    const Primitive& primitive = model.nodes[edge.child].primitive;
    if (edge.upright && primitive == PrimitiveKind::cube) return EvenPart::Kind::cube;
    return primitive == PrimitiveKind::triangle ? EvenPart::Kind::triangle : EvenPart::Kind::primitive;
}

/// Notes the parts in a tree of a node that lie within its reach.
void note_within(TraceModel& model, const TraceNode& node, std::uint32_t tree) {
    if (tree == no_tree || node.kind != TraceNode::Kind::parts) return;
    constexpr double rounding = 1e-9; // of which surely_more is careful
    for (const std::uint32_t item : model.boxes[tree].entry) {
        if (item & BoxNode::inner) {
            note_within(model, node, item & ~BoxNode::inner);
        } else if (!LeafGroup::is(item) && !model.edges[item].to_primitive) {
            const TraceEdge& edge = model.edges[item];
            const TraceNode& child = model.nodes[edge.child];
            const Vec3 centre = edge.parent_from_child.affine()(vec3_of(child.ball_centre));
            model.even_parts[item].within =
                glm::distance(centre, vec3_of(node.ball_centre)) + edge.stretch * child.reach <=
                (1 + rounding) * node.reach;
        }
    }
}

Double4 with_scale(const LaneMap& map) {
    Double4 lanes = map.translation;
    lanes[3] = map.column[0][0];
    return lanes;
}

} // namespace

void add_even_parts(TraceModel& model) {
    model.even_parts.reserve(model.edges.size());
    model.even_offsets.reserve(model.edges.size());
    for (const TraceEdge& edge : model.edges) {
        model.even_parts.push_back({.shift = with_scale(edge.child_from_parent),
                                    .stretch = edge.stretch,
                                    .growth = edge.growth,
                                    .child = edge.child,
                                    .levels = edge.levels,
                                    .kind = kind_of(model, edge),
                                    .upright = edge.upright});
        model.even_offsets.push_back({with_scale(edge.parent_from_child)});
    }
    for (const TraceNode& node : model.nodes) {
        note_within(model, node, node.tree);
        for (std::uint32_t i = 0; i < node.unrolling_count; ++i)
            note_within(model, node, model.unrollings[node.first_unrolling + i].tree);
    }
}

} // namespace graftal
