#pragma once

#include <limits>

#include "compiler/support/affine.h"

namespace graftal {

/// The points origin + t * direction. The direction is finite and not zero; it need not be of unit length, so
/// that t stays what it is when the ray is taken into another frame.
struct Ray {
    Vec3 origin{0.0};
    Vec3 direction{0, 0, -1};

    Vec3 operator()(double t) const { return origin + t * direction; }
};

/// The part of a ray that counts: least < t < most.
struct RayRange {
    double least = 0;
    double most = std::numeric_limits<double>::infinity();
};

} // namespace graftal
