#include "compiler/primitives/part_size.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

double part_size(const Primitive& primitive, const Mat3& world_from_primitive) {
    const PrimitiveTraits& traits = traits_of(primitive);
    if (!traits.bounded) return 1;
    const Vec3 extent = 0.5 * traits.box(primitive).size();
    const double a = extent.x * glm::length(world_from_primitive[0]),
                 b = extent.y * glm::length(world_from_primitive[1]),
                 c = extent.z * glm::length(world_from_primitive[2]);
    const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
    return middle > 0 && std::isfinite(middle) ? middle : 1;
}

} // namespace graftal
