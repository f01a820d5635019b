#include "compiler/primitives/primitive.h"

#include <glm/geometric.hpp>

namespace graftal {

double primitive_support(const Primitive& primitive, Vec3 direction) {
    return glm::dot(direction, traits_of(primitive).support_point(primitive, direction));
}

} // namespace graftal
