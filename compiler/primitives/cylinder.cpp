#include "compiler/primitives/primitive.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/tapered.h"

namespace graftal {
namespace {

Vec3 support_point(const Primitive&, Vec3 direction) {
    return farthest_on_circle(direction, direction.y > 0 ? 1 : 0);
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    return intersect_tapered(1, ray, range, hit);
}

} // namespace

constinit const PrimitiveTraits cylinder_traits = tapered_row(
    {.support_point = support_point, .hull = tapered_hull, .mesh = tapered_mesh, .intersect = intersect});

} // namespace graftal
