#include "compiler/primitives/intersect.h"

#include <glm/geometric.hpp>

namespace graftal {
namespace {

/// False for what is not finite, and for what is so large or small that squares and roots of it mean nothing.
bool is_sane(const Ray& ray) {
    constexpr double most = 1e12;
    const double far2 = glm::dot(ray.origin, ray.origin), speed2 = glm::dot(ray.direction, ray.direction);
    return far2 <= most * most && speed2 <= most * most && speed2 >= 1 / (most * most);
}

} // namespace

bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit,
               std::uint64_t most_steps) {
    if (!is_sane(ray)) return false;
    const PrimitiveTraits& row = traits_of(primitive);
    return row.intersect_within ? row.intersect_within(primitive, ray, range, hit, most_steps)
                                : row.intersect(primitive, ray, range, hit);
}

} // namespace graftal
