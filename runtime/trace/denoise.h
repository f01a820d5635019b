#pragma once

#include <vector>

#include "compiler/light/film.h"
#include "compiler/support/control.h"
#include "compiler/support/workers.h"
#include "runtime/image/image.h"
#include "runtime/trace/noise_meter.h"
#include "runtime/trace/pixel_features.h"

namespace graftal {

/// A picture without most of its noise, in linear light.
struct Denoised {
    Image picture;
    std::vector<float> errors_255; ///< about what is left of each pixel's, as the film shows it

    double mean_error_255() const;
};

/// A picture from samples of light that is noisy, and from features that are less so. A window around each
/// pixel gives light as a linear function of the features (K. He et al., "Guided image filtering", 2013; B.
/// Bitterli et al., "Nonlinearly weighted first-order regression", 2016), once for each half of the samples.
/// The other half tells the error of that estimate; it and the samples' own error weigh the two.
///
/// Requires samples taken in halves (Sampling::denoise), and as many samples and features as pixels.
/// Ensures the same bits on any number of workers. A pixel with one sample keeps it; one
/// without shows what its features and its neighbours tell. What it returns after `cancel` was raised is of
/// no use.
Denoised denoise(const std::vector<NoiseMeter>& samples, const std::vector<PixelFeatures>& features,
                 int width, int height, const Film& film, const Workers& workers,
                 const CancelFlag& cancel = {});

} // namespace graftal
