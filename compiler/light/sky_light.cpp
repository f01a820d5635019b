#include "compiler/light/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/light/formulas.h"
#include "compiler/support/axes_across.h"

namespace graftal {

namespace {

double perez_at(const std::array<double, 5>& c, double cos_zenith, double cos_sun) {
    return formulas::perez_at(c[0], c[1], c[2], c[3], c[4], cos_zenith, cos_sun);
}

/// a t^3 + b t^2 + c t + d
double cubic(double t, double a, double b, double c, double d) {
    return ((a * t + b) * t + c) * t + d;
}

/// Luminance in kcd/m2, and chromaticities.
Rgb zenith_of(double turbidity, double sun_from_zenith) {
    const double t = turbidity, s = sun_from_zenith;
    const double chi = (4.0 / 9 - t / 120) * (std::numbers::pi - 2 * s);
    return {
        (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192,
        t * t * cubic(s, 0.00166, -0.00375, 0.00209, 0) + t * cubic(s, -0.02903, 0.06377, -0.03202, 0.00394) +
            cubic(s, 0.11693, -0.21196, 0.06052, 0.25886),
        t * t * cubic(s, 0.00275, -0.00610, 0.00317, 0) + t * cubic(s, -0.04214, 0.08970, -0.04153, 0.00516) +
            cubic(s, 0.15346, -0.26756, 0.06670, 0.26688)};
}

} // namespace

ClearSky::ClearSky(double turbidity, Vec3 towards_sun, Vec3 up) : to_sun(towards_sun) {
    constexpr double lowest_sun = 0.01; // cosine; the luminance of the zenith is fitted above
    const double cosine = std::clamp(glm::dot(to_sun, up), lowest_sun, 1.0);
    if (glm::dot(to_sun, up) < lowest_sun) {
        const Vec3 level = to_sun - glm::dot(to_sun, up) * up;
        constexpr double straight_below = 1e-9;
        const Vec3 way = glm::length(level) > straight_below ? glm::normalize(level) : axes_across(up).a;
        to_sun = cosine * up + std::sqrt(1 - cosine * cosine) * way;
    }
    const double t = turbidity;
    perez = {{{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
               -0.0670 * t + 0.3703},
              {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
               -0.0033 * t + 0.0452},
              {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
               -0.0109 * t + 0.0529}}};
    zenith_yxy = zenith_of(t, std::acos(cosine));
    for (int i = 0; i < 3; ++i)
        zenith_yxy[i] /= perez_at(perez[static_cast<std::size_t>(i)], 1, cosine);
}

Rgb ClearSky::radiance(Vec3 direction, Vec3 up) const {
    const double height = glm::dot(direction, up);
    const double cos_sun = glm::dot(direction, to_sun);
    Rgb yxy;
    for (int i = 0; i < 3; ++i)
        yxy[i] = zenith_yxy[i] *
                 perez_at(perez[static_cast<std::size_t>(i)], std::max(height, least_height), cos_sun);
    return formulas::light_of_yxy(yxy);
}

Rgb SkyLight::radiance(Vec3 direction) const {
    if (picture) return brightness * picture->radiance(picture_from_world * direction);
    const double height = glm::dot(direction, up);
    if (height < 0) return below;
    if (clear) return brightness / ClearSky::kcd_of_paper * clear->radiance(direction, up);
    const double t = std::min(height / full_height, 1.0);
    return (1 - t) * horizon + t * zenith;
}

/// The mean over the upper half, whose heights are those of the middles of equal shares of [0, 1].
template<typename Height> Rgb SkyLight::mean_above(const Height& height_at) const {
    constexpr int rings = 64, parts = 64;
    const auto [x, z] = axes_across(up);
    Rgb sum(0.0);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < parts; ++j) {
            const double height = height_at((i + 0.5) / rings), sine = std::sqrt(1 - height * height);
            const double turn = 2 * std::numbers::pi * (j + 0.5) / parts;
            sum += radiance(height * up + sine * (std::cos(turn) * x - std::sin(turn) * z));
        }
    return sum / static_cast<double>(rings * parts);
}

Rgb SkyLight::on_paper() const {
    if (picture) return brightness * picture->on_paper();
    return mean_above([](double share) { return std::sqrt(1 - share); }); // as a cosine weighs them
}

Rgb SkyLight::average() const {
    if (!picture) return 0.5 * (below + mean_above([](double share) { return share; }));
    Rgb sum(0.0);
    for (const SkyCells::Cell& cell : picture->cells().cells)
        sum += Rgb(cell.power);
    return brightness / (4 * std::numbers::pi) * sum;
}

} // namespace graftal
