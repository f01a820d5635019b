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

bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    return is_sane(ray) && traits_of(primitive).intersect(primitive, ray, range, hit);
}

} // namespace graftal
