#pragma once

#include <algorithm>

#include "compiler/support/affine.h"
#include "compiler/support/tint.h"

namespace graftal {

/// A level disc that shows the shade of a model and fades into the background. It takes light as white paper
/// of its colour does, and keeps none from anything.
struct ShadowCatcher {
    Vec3 centre{0.0};
    double radius = 1;
    Rgb rgb{0.5};

    /// The share of what lies behind that it hides, at a point of its plane: from 1 at the centre to 0 at the
    /// radius, (1 - (r / radius)^2)^2.
    double opacity(Vec3 point) const {
        const double x = (point.x - centre.x) / radius, z = (point.z - centre.z) / radius;
        const double inside = std::max(0.0, 1 - x * x - z * z);
        return inside * inside;
    }
};

} // namespace graftal
