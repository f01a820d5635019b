#include "runtime/trace/sampling.h"

#include <algorithm>

namespace graftal {

double Sampling::samples_a_pixel() const {
    if (block == 1 && most_samples > 0) return static_cast<double>(most_samples) / sparse;
    const double across = steps();
    return across * across / (static_cast<double>(block) * block);
}

int Sampling::feature_rays() const {
    constexpr int enough = 4;
    return denoise && most_samples >= 2 ? std::min(most_samples / 2, enough) : 0;
}

double Sampling::cost_in_samples() const {
    constexpr double share_of_sample = 0.5;
    return samples_a_pixel() + share_of_sample * feature_rays();
}

TraceStatistics& TraceStatistics::operator+=(const TraceStatistics& other) {
    camera_rays += other.camera_rays;
    work += other.work;
    given_up += other.given_up;
    noisy_pixels += other.noisy_pixels;
    noise_1024 += other.noise_1024;
    measured_pixels += other.measured_pixels;
    return *this;
}

std::optional<double> TraceStatistics::noise_255() const {
    if (measured_pixels == 0) return {};
    return static_cast<double>(noise_1024) / 1024 / static_cast<double>(measured_pixels);
}

} // namespace graftal
