#include <cmath>

#include "compiler/primitives/primitive.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/tapered.h"
#include "compiler/support/number.h"

namespace graftal {
namespace {

std::optional<Primitive> make(std::span<const double> numbers, std::string& fault) {
    if (numbers[0] >= 0 && numbers[0] <= 1) return tapered(numbers[0]);
    fault = "the upper radius of a frustum lies between 0 and 1, not at " + shortest(numbers[0]);
    return std::nullopt;
}

/// Through the rims of both caps.
Ball ball(const Primitive& frustum) {
    const double top = top_radius(frustum), middle = top * top / 2;
    return {{0, middle, 0}, std::hypot(1.0, middle)};
}

Vec3 support_point(const Primitive& frustum, Vec3 direction) {
    const Vec3 low = farthest_on_circle(direction, 0);
    return farther(direction, Vec3(0, 1, 0) + top_radius(frustum) * low, low);
}

std::vector<HullPiece> hull(const Primitive& frustum) {
    const Affine top = Affine::translate({0, 1, 0}) * Affine::scale(Vec3(top_radius(frustum)));
    return {{HullPiece::Kind::disc, Affine()}, {HullPiece::Kind::disc, top}};
}

TessellatedPrimitive mesh(const Primitive& frustum, int fineness) {
    return tapered_mesh(fineness, top_radius(frustum));
}

bool intersect(const Primitive& frustum, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    return intersect_tapered(top_radius(frustum), ray, range, hit);
}

} // namespace

constinit const PrimitiveTraits frustum_traits = {
    .arguments = {1, 1},
    .make = make,
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
