#include <cmath>

#include "compiler/primitives/primitive.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/tapered.h"

namespace graftal {
namespace {

Ball ball(const Primitive&) {
    return {{0, 0.5, 0}, std::hypot(1.0, 0.5)};
}

Vec3 support_point(const Primitive&, Vec3 direction) {
    return farthest_on_circle(direction, direction.y > 0 ? 1 : 0);
}

std::vector<HullPiece> hull(const Primitive&) {
    return {{HullPiece::Kind::disc, Affine()}, {HullPiece::Kind::disc, Affine::translate({0, 1, 0})}};
}

TessellatedPrimitive mesh(const Primitive&, int fineness) {
    return tapered_mesh(fineness, 1);
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    return intersect_tapered(1, ray, range, hit);
}

} // namespace

constinit const PrimitiveTraits cylinder_traits = {
    .box = tapered_box,
    .ball = ball,
    .support_point = support_point,
    .hull = hull,
    .convex_parts = tapered_convex_parts,
    .inner_radius = tapered_inner_radius,
    .fixed_point = tapered_fixed_point,
    .keeps = tapered_keeps,
    .max_fineness = finest_tapered_mesh,
    .mesh = mesh,
    .mesh_error = tapered_mesh_error,
    .wrap = tapered_wrap,
    .texture_point = tapered_texture_point,
    .area = tapered_area,
    .site = tapered_site,
    .intersect = intersect,
};

} // namespace graftal
