#include "compiler/support/hue.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace graftal {

namespace {

/// Where the hue is, from 0 to 6; requires that the components differ.
double sextants(Rgb c, double largest, double range) {
    if (largest == c.r) return (c.g - c.b) / range;
    if (largest == c.g) return 2 + (c.b - c.r) / range;
    return 4 + (c.r - c.g) / range;
}

} // namespace

Rgb rgb_from_hsv(double hue_deg, double saturation, double value) {
    const double sextant = 6 * (hue_deg / 360 - std::floor(hue_deg / 360));
    const auto component = [&](double offset) {
        const double k = std::fmod(sextant + offset, 6.0);
        return value - value * saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    };
    return {component(5), component(3), component(1)};
}

Hsv hsv_from_rgb(Rgb rgb) {
    const double largest = std::max({rgb.r, rgb.g, rgb.b}), least = std::min({rgb.r, rgb.g, rgb.b});
    if (is_grey(rgb)) return {0, 0, largest};
    const double sextant = sextants(rgb, largest, largest - least);
    return {60 * (sextant < 0 ? sextant + 6 : sextant), (largest - least) / largest, largest};
}

Rgb hue_turned(Rgb rgb, double turns) {
    if (is_grey(rgb)) return rgb;
    const double largest = std::max({rgb.r, rgb.g, rgb.b}), least = std::min({rgb.r, rgb.g, rgb.b});
    const double range = largest - least;
    const double hue_deg = 60 * sextants(rgb, largest, range) + 360 * turns;
    return glm::clamp(rgb_from_hsv(hue_deg, range / largest, largest), Rgb(0.0), Rgb(largest));
}

bool is_grey(Rgb rgb) {
    return rgb.r == rgb.g && rgb.g == rgb.b;
}

} // namespace graftal
