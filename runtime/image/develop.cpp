#include "runtime/image/develop.h"

#include <array>
#include <cmath>

#include "compiler/light/blackbody.h"

namespace graftal {

namespace {

double rolled_off(double x, bool soft) {
    return soft && x > 0.5 ? 1 - 0.5 * std::exp(1 - 2 * x) : x;
}

/// In [-1/2, 1/2): neighbours differ, and means over a few pixels are 0 (Jimenez 2014, interleaved gradient
/// noise).
double dither(int x, int y, int channel) {
    constexpr int apart = 47; // the channels' patterns
    const double t = 0.06711056 * (x + apart * channel) + 0.00583715 * (y + apart * channel);
    const double wave = 52.9829189 * (t - std::floor(t));
    return wave - std::floor(wave) - 0.5;
}

} // namespace

double developed(double light, const Film& film) {
    return srgb_encoded(static_cast<float>(rolled_off(film.exposure * light, film.soft)));
}

void develop_rows(Image& picture, const Film& film, int first, int end) {
    constexpr double neutral_k = 6504;
    const Rgb gains = blackbody_rgb(neutral_k) / glm::max(blackbody_rgb(film.white_k), Rgb(1e-3));
    const bool dithered = !film.plain();
    const int colours = picture.channels < 3 ? 1 : 3;
    for (int y = first; y < end; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                      static_cast<std::size_t>(x);
            float* const samples = picture.pixels.data() + pixel * static_cast<std::size_t>(picture.channels);
            for (int c = 0; c < colours; ++c) {
                const double gain = film.white_k == neutral_k || colours == 1 ? 1 : gains[c];
                const double value = developed(gain * samples[c], film);
                samples[c] = static_cast<float>(dithered ? value + dither(x, y, c) / 255 : value);
            }
        }
}

} // namespace graftal
