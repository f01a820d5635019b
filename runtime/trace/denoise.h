#pragma once

#include <array>
#include <vector>

#include "compiler/light/film.h"
#include "compiler/support/control.h"
#include "compiler/support/workers.h"
#include "runtime/image/image.h"
#include "runtime/trace/noise_meter.h"

namespace graftal {

/// The first surfaces behind a pixel as linear measures, so that a pixel that sees several shows their
/// mixture: coverage, and times it the colour (3), the normal (3), the nearness, and the light of lamps.
using PixelFeatures = std::array<float, 9>;
inline constexpr std::size_t near_feature = 7, light_feature = 8;

/// A picture from samples of light that is noisy, and from features that are less so. A window around each
/// pixel gives light as a linear function of the features (K. He et al., "Guided image filtering", 2013; B.
/// Bitterli et al., "Nonlinearly weighted first-order regression", 2016), once for each half of the samples.
/// The other half tells the error of that estimate; it and the samples' own error weigh the two.
///
/// Requires samples taken in halves (Sampling::denoise), and as many samples and features as pixels.
/// Ensures linear light, and the same bits on any number of workers. A pixel with one sample keeps it; one
/// without shows what its features and its neighbours tell. What it returns after `cancel` was raised is of
/// no use.
struct Denoised {
    Image picture;
    std::vector<float> errors_255; ///< about what is left of each pixel's, as the film shows it

    double mean_error_255() const;
};
Denoised denoise(const std::vector<NoiseMeter>& samples, const std::vector<PixelFeatures>& features,
                 int width, int height, const Film& film, const Workers& workers,
                 const CancelFlag& cancel = {});

} // namespace graftal
