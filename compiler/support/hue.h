#pragma once

#include "compiler/support/tint.h"

namespace graftal {

/// Hue in degrees, saturation and value as linear components (A. R. Smith 1978, "Color gamut transform
/// pairs"): the largest component is `value`, the smallest value * (1 - saturation), and the hues 0, 120 and
/// 240 are red, green and blue. Requires a finite hue, and a saturation in [0, 1].
Rgb rgb_from_hsv(double hue_deg, double saturation, double value);

struct Hsv {
    double hue_deg = 0; ///< in [0, 360)
    double saturation = 0;
    double value = 0;
};

/// The inverse of rgb_from_hsv(); greys have the hue 0, and black the saturation 0. Requires components >= 0.
Hsv hsv_from_rgb(Rgb rgb);

/// The colour with its hue turned by a share of a whole turn; saturation and value stay. Greys stay as they
/// are, to the last bit.
Rgb hue_turned(Rgb rgb, double turns);

/// Without a hue: equal components.
bool is_grey(Rgb rgb);

} // namespace graftal
