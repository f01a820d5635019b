#include "runtime/image/develop.h"

#include <cmath>

#include <glm/common.hpp>

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

Developer::Developer(const Film& film, SampleFormat format, int left, int top)
    : film_(film), largest_level_(largest_level(format)), left_(left), top_(top) {
    const double neutral_k = Film().white_k;
    if (film.white_k != neutral_k)
        gains_ = blackbody_rgb(neutral_k) / glm::max(blackbody_rgb(film.white_k), Rgb(1e-3));
}

void Developer::develop(Image& picture, int first, int end) const {
    const bool dithered = !film_.plain();
    const bool grey = picture.channels < 3;
    struct Shown {
        float light = NAN;
        double value = 0;
    } last[3]; // of coarse pictures and plain backgrounds most pixels are as the one before
    for (int y = first; y < end; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                      static_cast<std::size_t>(x);
            float* const samples = picture.pixels.data() + pixel * static_cast<std::size_t>(picture.channels);
            for (int c = 0; c < (grey ? 1 : 3); ++c) {
                if (samples[c] != last[c].light)
                    last[c] = {samples[c], developed((grey ? 1 : gains_[c]) * samples[c], film_)};
                const double value = last[c].value;
                samples[c] = static_cast<float>(
                    dithered ? value + dither(left_ + x, top_ + y, c) / largest_level_ : value);
            }
        }
}

} // namespace graftal
