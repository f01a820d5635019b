#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// The point of the circle of radius 1 about the y axis, at this height, that is farthest along `direction`.
inline Vec3 farthest_on_circle(Vec3 direction, double height) {
    const double length = std::hypot(direction.x, direction.z);
    if (!(length > 0)) return {1, height, 0};
    return {direction.x / length, height, direction.z / length};
}

/// The one of two points that is farther along `direction`.
inline Vec3 farther(Vec3 direction, Vec3 a, Vec3 b) {
    return glm::dot(direction, a) >= glm::dot(direction, b) ? a : b;
}

/// The point of the unit circle about the y axis, at y = 0, at this share of a turn from x to z.
Vec3 circle_point(double turn);

} // namespace graftal
