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
    double sun = 0;      ///< the share of its light that is the first sun's, where that is not shadowed

    bool is_even() const { return std::isinf(height); }

    /// The share of what lies behind that is seen through `length` of it along a ray. POV-Ray 3.7's
    /// `fog_type 2`: the density is 1 / (1 + s^2) at s = (y - base) / height > 0, and 1 below. Requires a
    /// positive distance and height.
    double left_after(Vec3 from, Vec3 direction, double length) const;

    /// The way along a ray of which the haze's light makes up this share (in [0, 1]) of that of all its
    /// `length`.
    double length_of_share(Vec3 from, Vec3 direction, double length, double share) const;

    /// The light of the sun's share in a direction (unit) of view, where the whole would be 1 from all
    /// directions alike: Henyey and Greenstein's phase function (Astrophysical Journal 93, 1941), which
    /// prefers the way on.
    static double scattered(Vec3 direction, Vec3 to_sun);
};

} // namespace graftal
