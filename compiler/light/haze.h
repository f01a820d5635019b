#pragma once

#include <cmath>

#include "compiler/support/affine.h"
#include "compiler/support/tint.h"

namespace graftal {

/// Air that takes light away and shows its own: even up to a height, thinner above, as POV-Ray's ground fog.
struct Haze {
    Rgb rgb{0.7, 0.8, 0.9};
    double distance = 0; ///< after which 1/e of what lies behind is left, where it is even
    double base = 0;     ///< the height y from which it thins
    double height = 1;   ///< over the base, at which half of its density is left; infinite: even all over

    bool is_even() const { return std::isinf(height); }

    /// The share of what lies behind that is seen through `length` of it along a ray. POV-Ray 3.7's
    /// `fog_type 2`: the density is 1 / (1 + s^2) at s = (y - base) / height > 0, and 1 below. Requires a
    /// positive distance and height.
    double left_after(Vec3 from, Vec3 direction, double length) const;
};

} // namespace graftal
