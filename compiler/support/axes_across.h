#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// Two unit vectors at right angles to a third, and to each other.
struct AxesAcross {
    Vec3 a, b;
};

/// Requires a unit vector.
inline AxesAcross axes_across(Vec3 direction) {
    const Vec3 other = std::abs(direction.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 a = glm::normalize(glm::cross(direction, other));
    return {a, glm::cross(direction, a)};
}

} // namespace graftal
