#include "compiler/support/angle.h"

#include <cmath>
#include <numbers>

namespace graftal {

std::pair<double, double> cos_sin_deg(double angle_deg) {
    const double turn = std::abs(angle_deg) <= 180 ? angle_deg : std::remainder(angle_deg, 360.0);
    if (turn == 0) return {1, 0};
    if (turn == 90) return {0, 1};
    if (turn == -90) return {0, -1};
    if (std::abs(turn) == 180) return {-1, 0};
    const double angle = turn * std::numbers::pi / 180;
    return {std::cos(angle), std::sin(angle)};
}

} // namespace graftal
