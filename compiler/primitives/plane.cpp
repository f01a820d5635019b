#include "compiler/primitives/passage.h"
#include "compiler/primitives/primitive.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/check.h"

namespace graftal {
namespace {

Box box(const Primitive&) {
    return {};
}

Ball ball(const Primitive&) {
    return {};
}

Vec3 support_point(const Primitive&, Vec3) {
    GRAFTAL_CHECK(false, "a plane has no support function");
}

std::vector<HullPiece> hull(const Primitive&) {
    GRAFTAL_CHECK(false, "a plane has no ball");
}

std::vector<ConvexPart> convex_parts(const Primitive&) {
    GRAFTAL_CHECK(false, "a plane has no shadow");
}

double inner_radius(const Primitive&) {
    return 0.5;
}

Vec3 fixed_point(const Primitive&) {
    return Vec3(0.0);
}

bool keeps(const Primitive&, const Affine& map) {
    return turns_about_origin(map) && keeps_y_axis(map.linear) && map.linear[1][1] > 0;
}

TessellatedPrimitive mesh(const Primitive&, int) {
    GRAFTAL_CHECK(false, "tessellate: a plane has no mesh");
}

double mesh_error(const Primitive&, int) {
    GRAFTAL_CHECK(false, "tessellate: a plane has no mesh");
}

TexturePoint texture_point(const Primitive&, const TextureSpace& space, Vec3 point) {
    return {turn_about_y(space, point), 0};
}

double area(const Primitive&) {
    GRAFTAL_CHECK(false, "a plane has no area");
}

SurfaceSite site(const Primitive&, Vec3) {
    GRAFTAL_CHECK(false, "a plane has no random points");
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    // A parallel ray gives a number that is not finite, and no range holds it.
    const double t = -ray.origin.y / ray.direction.y;
    if (!holds(range, t)) return false;
    hit = {t, {0, 1, 0}};
    return true;
}

} // namespace

constinit const PrimitiveTraits plane_traits = {
    .bounded = false,
    .box = box,
    .ball = ball,
    .support_point = support_point,
    .hull = hull,
    .convex_parts = convex_parts,
    .inner_radius = inner_radius,
    .fixed_point = fixed_point,
    .keeps = keeps,
    .mesh = mesh,
    .mesh_error = mesh_error,
    .texture_point = texture_point,
    .area = area,
    .site = site,
    .intersect = intersect,
};

} // namespace graftal
