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

Vec3 support_point(const Primitive& frustum, Vec3 direction) {
    const Vec3 low = farthest_on_circle(direction, 0);
    return farther(direction, Vec3(0, 1, 0) + top_radius(frustum) * low, low);
}

bool intersect(const Primitive& frustum, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    return intersect_tapered(top_radius(frustum), ray, range, hit);
}

} // namespace

constinit const PrimitiveTraits frustum_traits = tapered_row({
    .arguments = {1, 1},
    .make = make,
    .support_point = support_point,
    .hull = tapered_hull,
    .mesh = tapered_mesh,
    .intersect = intersect,
});

} // namespace graftal
