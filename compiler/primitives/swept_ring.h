#pragma once

#include "compiler/support/affine.h"

namespace graftal {

/// A ring of a surface that is swept along a curve.
struct SweptRing {
    Vec3 centre; ///< on the curve
    double radius;
    Vec3 along;   ///< the direction of the curve, of unit length
    double slope; ///< change of the radius along the curve
    Vec3 side;    ///< of unit length, at right angles to `along`: where the ring begins
};

/// A unit vector at right angles to another.
Vec3 some_side(Vec3 along);

/// The side of the first ring, taken along the curve to the second without turning about the curve (W. Wang,
/// B. Juttler, D. Zheng and Y. Liu, "Computation of Rotation Minimizing Frames", 2008: by two reflections).
Vec3 moved_side(const SweptRing& from, const SweptRing& to);

} // namespace graftal
