#pragma once

#include <array>
#include <memory>
#include <optional>

#include "compiler/light/sky_picture.h"
#include "compiler/support/affine.h"
#include "compiler/support/tint.h"

namespace graftal {

/// Radiance of a cloudless sky by Preetham, Shirley and Smits, "A practical analytic model for daylight"
/// (1999), appendix A.2: Perez's five coefficients of luminance and of the two chromaticities.
struct ClearSky {
    static constexpr double least_turbidity = 2, most_turbidity = 10;

    /// The sine of the lowest height that the formula is taken at: at the horizon it divides by 0.
    static constexpr double least_height = 1e-3;

    /// White paper under the sun overhead, of 100 klx, has 100 / pi kcd/m2.
    static constexpr double kcd_of_paper = 31.83;

    /// Requires a turbidity in that range, and a unit vector towards the sun; one below the horizon stands
    /// on it.
    ClearSky(double turbidity, Vec3 to_sun, Vec3 up);

    /// The radiance in kcd/m2 of a direction (unit) in the upper half; below, that at the horizon.
    Rgb radiance(Vec3 direction, Vec3 up) const;

    std::array<std::array<double, 5>, 3> perez; ///< of Y, x and y
    Rgb zenith_yxy;                             ///< over perez at the zenith
    Vec3 to_sun;
    bool operator==(const ClearSky&) const = default;
};

/// The light that comes from all directions, where no surface stands in between. A radiance of 1 is that of
/// white paper under a light of 1.
struct SkyLight {
    Vec3 up{0, 1, 0};
    Rgb zenith{0.0}, horizon{0.0}; ///< from one to the other, linearly in the height up to full_height
    Rgb below{0.0};                ///< of all directions below the horizon
    std::optional<ClearSky> clear; ///< in place of zenith and horizon
    std::shared_ptr<const SkyPicture> picture; ///< in place of all these
    Mat3 picture_from_world{1.0};              ///< turns directions
    double brightness = 1; ///< of the picture, or the clear sky; 1: as under a sun of brightness 1
    unsigned bounces = 0;  ///< of light between surfaces, by engines that follow it

    /// The sine of the height at which the zenith's colour is reached.
    static constexpr double full_height = 0.6;

    /// Along a unit vector, from there.
    Rgb radiance(Vec3 direction) const;
    bool operator==(const SkyLight&) const = default;

    /// The irradiance of a surface that faces up, over pi: the light that white paper shows.
    Rgb on_paper() const;
    /// The mean over all directions.
    Rgb average() const;

  private:
    template<typename Height> Rgb mean_above(const Height& height_at) const;
};

} // namespace graftal
