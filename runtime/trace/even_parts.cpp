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

Double4 with_scale(const LaneMap& map) {
    Double4 lanes = map.translation;
    lanes[3] = map.column[0][0];
    return lanes;
}

} // namespace

std::vector<EvenPart> even_parts(const TraceModel& model) {
    std::vector<EvenPart> parts;
    parts.reserve(model.edges.size());
    for (const TraceEdge& edge : model.edges)
        parts.push_back({.shift = with_scale(edge.child_from_parent),
                         .stretch = edge.stretch,
                         .growth = edge.growth,
                         .child = edge.child,
                         .levels = edge.levels,
                         .kind = kind_of(model, edge),
                         .upright = edge.upright});
    return parts;
}

std::vector<EvenOffset> even_offsets(const TraceModel& model) {
    std::vector<EvenOffset> offsets;
    offsets.reserve(model.edges.size());
    for (const TraceEdge& edge : model.edges)
        offsets.push_back({with_scale(edge.parent_from_child)});
    return offsets;
}

} // namespace graftal
