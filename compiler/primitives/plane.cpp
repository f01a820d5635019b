#include "compiler/primitives/passage.h"
#include "compiler/primitives/primitive.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/check.h"

namespace graftal {
namespace {

/// A column that nobody asks for.
template<typename Answer, typename... Asked> Answer without_end(const Primitive&, Asked...) {
    GRAFTAL_CHECK(false, "a plane has no end: it has no bounds, mesh, area and shadow");
}

Box box(const Primitive&) {
    return {};
}

Ball ball(const Primitive&) {
    return {};
}

double inner_radius(const Primitive&) {
    return 0.5;
}

bool keeps(const Primitive&, const Affine& map) {
    return turns_about_origin(map) && keeps_y_axis(map.linear) && map.linear[1][1] > 0;
}

TexturePoint texture_point(const Primitive&, const TextureSpace& space, Vec3 point) {
    return {turn_about_y(space, point), 0};
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
    .support_point = without_end,
    .hull = without_end,
    .convex_parts = without_end,
    .inner_radius = inner_radius,
    .fixed_point = origin_of,
    .keeps = keeps,
    .mesh = without_end,
    .mesh_error = without_end,
    .texture_point = texture_point,
    .area = without_end,
    .site = without_end,
    .intersect = intersect,
};

} // namespace graftal
