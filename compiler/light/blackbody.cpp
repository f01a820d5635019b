#include "compiler/light/blackbody.h"

#include <cmath>

#include <glm/common.hpp>

#include "compiler/light/formulas.h"

namespace graftal {

namespace {

/// A lobe with one width on each side.
double lobe(double wavelength_nm, double peak_nm, double inverse_left, double inverse_right) {
    const double t = (wavelength_nm - peak_nm) * (wavelength_nm < peak_nm ? inverse_left : inverse_right);
    return std::exp(-0.5 * t * t);
}

/// The colour matching functions of the CIE 1931 observer: Wyman, Sloan and Shirley, "Simple analytic
/// approximations to the CIE XYZ color matching functions", JCGT 2 (2013), eq. (4).
Rgb observer_xyz(double nm) {
    return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
                0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
            0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
            1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

/// Planck's law without its constant factor.
double emitted(double wavelength_nm, double temperature_k) {
    constexpr double second_radiation_constant = 1.438776877e7; // nm K
    const double relative = wavelength_nm / 560;                // near 1, so that powers stay in range
    return std::pow(relative, -5) / std::expm1(second_radiation_constant / (wavelength_nm * temperature_k));
}

} // namespace

Rgb rgb_from_xyz(Rgb xyz) {
    return formulas::linear_srgb_of(xyz);
}

Rgb blackbody_rgb(double temperature_k) {
    constexpr double first_nm = 380, last_nm = 780, step_nm = 2;
    Rgb xyz(0.0);
    for (double nm = first_nm; nm <= last_nm; nm += step_nm)
        xyz += emitted(nm, temperature_k) * observer_xyz(nm);
    return glm::max(rgb_from_xyz(xyz / xyz.y), Rgb(0.0));
}

} // namespace graftal
