#include "runtime/trace/even_parts.h"

#include "runtime/trace/trace_model.h"

namespace graftal {

namespace {

EvenPart::Kind kind_of(const TraceModel& model, const TraceEdge& edge) {
    if (!edge.to_primitive) return EvenPart::Kind::node;
    const Primitive& primitive = model.nodes[edge.child].primitive;
    if (edge.upright && primitive == PrimitiveKind::cube) return EvenPart::Kind::cube;
    return primitive == PrimitiveKind::triangle ? EvenPart::Kind::triangle : EvenPart::Kind::primitive;
}

} // namespace

std::vector<EvenPart> even_parts(const TraceModel& model) {
    std::vector<EvenPart> parts;
    parts.reserve(model.edges.size());
    for (const TraceEdge& edge : model.edges)
        parts.push_back({.shift = edge.child_from_parent.translation,
                         .offset = edge.parent_from_child.translation,
                         .shrink = edge.child_from_parent.column[0][0],
                         .entry = edge.parent_from_child.column[0][0],
                         .stretch = edge.stretch,
                         .growth = edge.growth,
                         .turns = edge.turns,
                         .child = edge.child,
                         .levels = edge.levels,
                         .kind = kind_of(model, edge),
                         .upright = edge.upright});
    return parts;
}

} // namespace graftal
