#pragma once

#include <limits>

#include "compiler/scene/scene.h"
#include "compiler/support/bounds.h"

namespace graftal {

/// Extents of the drawn things that decide on POV-Ray's units.
struct DrawnExtent {
    Box bounds;                                              ///< planes aside
    double largest_part = 0;                                 ///< longest side of the box of one placement
    double finest = std::numeric_limits<double>::infinity(); ///< least length in it that may be seen
};

/// Where the scene's own units lie in POV-Ray's: p -> scale * (p - origin).
struct PovrayUnits {
    double scale = 1;
    Vec3 origin{0.0};

    Vec3 operator()(Vec3 world) const { return scale * (world - origin); }
    Affine pov_from_world() const { return {Mat3(scale), -scale * origin}; }
};

/// POV-Ray's tolerances are absolute: it drops hits nearer than 1e-4 and shadows nearer than 1e-3, sees
/// nothing beyond 1e7, and keeps objects out of its tree that are larger than 2700. The scene is brought to
/// an extent of 400 to 1000 units by a round factor (1, 2 or 5 times a power of ten); to more, up to 30,000,
/// where the least length that may be seen would come near the tolerances and no part gets too large; or to
/// less where the camera would be farther than 5e6 from it; and about the origin, if it lies far from there.
PovrayUnits choose_units(const DrawnExtent& drawn, const Camera& camera);

} // namespace graftal
