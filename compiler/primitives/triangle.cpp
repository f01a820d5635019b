#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/primitives/passage.h"
#include "compiler/primitives/shape_parts.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/symmetry_maps.h"

namespace graftal {
namespace {

constexpr double half_sqrt3 = std::numbers::sqrt3 / 2;

/// Equilateral, on the unit circle about z, the apex up.
std::array<Vec3, 3> corners() {
    return {Vec3(0, 1, 0), Vec3(-half_sqrt3, -0.5, 0), Vec3(half_sqrt3, -0.5, 0)};
}

Box box(const Primitive&) {
    return {{-half_sqrt3, -0.5, 0}, {half_sqrt3, 1, 0}};
}

Ball ball(const Primitive&) {
    return {Vec3(0.0), 1};
}

Vec3 support_point(const Primitive&, Vec3 direction) {
    const auto [top, left, right] = corners();
    return farther(direction, top, farther(direction, left, right));
}

double inner_radius(const Primitive&) {
    return 0.5;
}

bool keeps(const Primitive&, const Affine& map) {
    const auto all = corners();
    return std::ranges::all_of(all, [&](const Vec3& corner) {
        return std::ranges::any_of(
            all, [&](const Vec3& other) { return glm::distance(map(corner), other) < symmetry_tolerance; });
    });
}

TessellatedPrimitive mesh(const Primitive&, int) {
    const auto [top, left, right] = corners();
    return {.vertices = {top, left, right}, .normals = {}, .triangles = {{0, 1, 2}}};
}

/// The picture over the triangle's box.
TexturePoint texture_point(const Primitive&, const TextureSpace&, Vec3 point) {
    return {0.5 + point.x / std::numbers::sqrt3, (point.y + 0.5) / 1.5};
}

double area(const Primitive&) {
    return 0.75 * std::sqrt(3.0);
}

SurfaceSite site(const Primitive&, Vec3 u) {
    const auto all = corners();
    const double root = std::sqrt(u.x);
    return {(1 - root) * all[0] + root * (1 - u.y) * all[1] + root * u.y * all[2], {0, 0, 1}};
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    constexpr double root3 = 1.7320508075688772;
    // A parallel ray gives a number that is not finite, and no range holds it.
    const double t = -ray.origin.z / ray.direction.z;
    if (!holds(range, t)) return false;
    const double x = ray.origin.x + t * ray.direction.x, y = ray.origin.y + t * ray.direction.y;
    if (!(y >= -0.5 - passage_rounding && root3 * std::abs(x) + y <= 1 + passage_rounding)) return false;
    hit = {t, {0, 0, 1}};
    return true;
}

} // namespace

constinit const PrimitiveTraits triangle_traits = flat_row(
    {
        .box = box,
        .ball = ball,
        .support_point = support_point,
        .inner_radius = inner_radius,
        .keeps = keeps,
        .mesh = mesh,
        .texture_point = texture_point,
        .area = area,
        .site = site,
        .intersect = intersect,
    },
    {.fixed_point = origin_of});

} // namespace graftal
