#pragma once

#include <utility>

namespace graftal {

/// Cosine and sine of an angle in degrees, exact at multiples of 90.
std::pair<double, double> cos_sin_deg(double angle_deg);

} // namespace graftal
