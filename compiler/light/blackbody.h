#pragma once

#include "compiler/support/tint.h"

namespace graftal {

inline constexpr double least_temperature_k = 1000, most_temperature_k = 40'000;

/// CIE XYZ in linear sRGB (IEC 61966-2-1). Components may be negative: of colours outside of its gamut.
Rgb rgb_from_xyz(Rgb xyz);

/// The colour of a black body by Planck's law, by the CIE 1931 observer (fit of Wyman, Sloan and Shirley
/// 2013). Its luminance is 1, no component is below 0. Requires a temperature in the range above.
Rgb blackbody_rgb(double temperature_k);

} // namespace graftal
