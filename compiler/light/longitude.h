#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/vec2.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// Where a picture of longitude and latitude (SkyPicture) has a direction: to the right and downwards, both
/// in [0, 1]. It need not be of unit length.
inline glm::dvec2 place_of(Vec3 direction) {
    const double u = 0.5 + std::atan2(direction.z, direction.x) / (2 * std::numbers::pi);
    const double v = std::atan2(std::hypot(direction.x, direction.z), direction.y) / std::numbers::pi;
    return {std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0)};
}

/// The unit vector at u to the right, of height y in [-1, 1].
inline Vec3 direction_at(double u, double y) {
    const double turn = 2 * std::numbers::pi * (u - 0.5), radius = std::sqrt(std::max(0.0, 1 - y * y));
    return {radius * std::cos(turn), y, radius * std::sin(turn)};
}

/// The four texels whose middles are about a place, and how near it is to the later ones: round the circle,
/// and not beyond the first and last row.
struct TexelMix {
    int x0, x1, y0, y1;
    double right, down; ///< of x1 and y1, in [0, 1]

    TexelMix(glm::dvec2 place, int width, int height) {
        const double x = place.x * width - 0.5, y = std::clamp(place.y * height - 0.5, 0.0, height - 1.0);
        right = x - std::floor(x);
        down = y - std::floor(y);
        x0 = x < 0 ? width - 1 : static_cast<int>(x);
        x1 = x0 + 1 < width ? x0 + 1 : 0;
        y0 = static_cast<int>(y);
        y1 = std::min(y0 + 1, height - 1);
    }
};

} // namespace graftal
