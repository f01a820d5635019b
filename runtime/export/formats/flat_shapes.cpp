#include "runtime/export/formats/flat_shapes.h"

#include <cmath>

#include "compiler/primitives/tessellate.h"

namespace graftal {

namespace {

/// Largest deviation from a right angle between a direction and an axis, as a cosine.
constexpr double from_the_side = 1e-6;

bool is_convex(PrimitiveKind kind) {
    switch (kind) {
    case PrimitiveKind::triangle:
    case PrimitiveKind::sphere:
    case PrimitiveKind::cube:
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return true;
    case PrimitiveKind::plane:
    case PrimitiveKind::torus:
    case PrimitiveKind::superellipsoid:
    case PrimitiveKind::polygon:
    case PrimitiveKind::bicubic_patch:
    case PrimitiveKind::sphere_sweep:
    case PrimitiveKind::limb_sweep:
    case PrimitiveKind::mesh:
        return false;
    }
    return false;
}

} // namespace

std::optional<std::array<Point2, 2>> axis_of(const SceneShape& shape, const SeenFrame& seen) {
    const PrimitiveKind kind = shape.primitive.kind();
    const bool is_long =
        kind == PrimitiveKind::cylinder || kind == PrimitiveKind::cone || kind == PrimitiveKind::frustum;
    if (!is_long || std::abs(seen.along().y) > from_the_side) return std::nullopt;
    return std::array{seen(Vec3(0.0)), seen(Vec3(0, 1, 0))};
}

FlatShape flat_shape(const SceneShape& shape, const SeenFrame& seen) {
    FlatShape flat;
    const PrimitiveKind kind = shape.primitive.kind();
    if (kind == PrimitiveKind::sphere) {
        flat.kind = FlatShape::Kind::disc;
        return flat;
    }
    if (const auto axis = axis_of(shape, seen); axis && kind == PrimitiveKind::cylinder) {
        flat.kind = FlatShape::Kind::stroke;
        flat.from = (*axis)[0];
        flat.to = (*axis)[1];
        return flat;
    }
    // Round parts are fine here, however small they are in the model: the file has each once.
    const int fineness = std::max(shape.fineness, std::min(3, max_fineness(shape.primitive)));
    const TessellatedPrimitive& mesh = tessellated(shape.primitive, fineness);
    std::vector<Point2> points;
    for (const Vec3& vertex : mesh.vertices)
        points.push_back(seen(vertex));
    if (is_convex(kind)) {
        flat.points = convex_outline(std::move(points));
        return flat;
    }
    flat.kind = FlatShape::Kind::triangles;
    for (const auto& t : mesh.triangles) {
        const Point2 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
        const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (area == 0) continue;
        // All in one sense, so that where they overlap they stay filled.
        flat.points.push_back(a);
        flat.points.push_back(area > 0 ? b : c);
        flat.points.push_back(area > 0 ? c : b);
    }
    return flat;
}

} // namespace graftal
