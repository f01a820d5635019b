#include "compiler/scene/povray_units.h"

#include <algorithm>
#include <cmath>

#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr double extent = 1000;
constexpr double largest_extent = 3e4;
constexpr double largest_part = 2000;
constexpr double farthest_camera = 5e6;
/// POV-Ray loses what is closer than about a thousandth (its SMALL_TOLERANCE).
constexpr double least_length = 0.02;

/// The largest of 1, 2, 5 times a power of ten that is not above the value.
double round_down(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {5.0, 2.0})
        if (step * power <= value) return step * power;
    return power;
}

} // namespace

PovrayUnits choose_units(const DrawnExtent& drawn, const Camera& camera) {
    const Box& bounds = drawn.bounds;
    PovrayUnits units;
    if (bounds.empty()) return units;
    const double distance = largest_entry(camera.location - bounds.centre());
    double size = 2 * largest_entry(0.5 * bounds.max - 0.5 * bounds.min);
    if (size == 0) size = camera.orthographic ? camera.width : distance;
    if (size == 0) size = 1;
    const double usual = extent / size;
    const double most =
        std::min(largest_extent / size, largest_part / std::max(drawn.largest_part, 1e-3 * size));
    const double wanted = std::clamp(least_length / drawn.finest, usual, std::max(most, usual));
    units.scale = round_down(std::min(wanted, farthest_camera / std::max(distance, size)));
    if (largest_entry(bounds.centre()) > 2 * size) units.origin = bounds.centre();
    GRAFTAL_CHECK(std::isfinite(units.scale) && units.scale > 0,
                  "POV-Ray's units: a scene beyond all scales");
    return units;
}

} // namespace graftal
