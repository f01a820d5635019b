#include "runtime/trace/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graftal {

namespace {

constexpr double a0 = 0.35875, a1 = 0.48829, a2 = 0.14128, a3 = 0.01168;

/// The window's integral from its left edge: of x in [0, 1], ends at 1.
double share_below(double x) {
    const double t = 2 * std::numbers::pi * x;
    const double integral = a0 * t - a1 * std::sin(t) + a2 / 2 * std::sin(2 * t) - a3 / 3 * std::sin(3 * t);
    return integral / (2 * std::numbers::pi * a0);
}

double inverse_share(double share) {
    double low = 0, high = 1;
    for (int halvings = 0; halvings < 50; ++halvings) {
        const double middle = 0.5 * (low + high);
        (share_below(middle) < share ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace

PixelFilter::PixelFilter() {
    for (int i = 0; i <= steps; ++i)
        offset_of_[static_cast<std::size_t>(i)] =
            radius_px * (2 * inverse_share(static_cast<double>(i) / steps) - 1);
}

double PixelFilter::weight(double offset) {
    const double c = -std::cos(std::numbers::pi * offset / radius_px); // of 2 and 3 angles by Chebyshev
    return a0 - a1 * c + a2 * (2 * c * c - 1) - a3 * c * (4 * c * c - 3);
}

double PixelFilter::offset(double u) const {
    const double at = u * steps;
    const auto step = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(steps - 1));
    const double part = at - static_cast<double>(step);
    return (1 - part) * offset_of_[step] + part * offset_of_[step + 1];
}

} // namespace graftal
