#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "compiler/support/tint.h"
#include "runtime/image/develop.h"

namespace graftal {

/// The mean of the samples of a pixel, and how far off it may be.
class NoiseMeter {
  public:
    /// Welford's running variance, of the luminance.
    void add(const Rgb& sample) {
        if (count_ % 2 == 0) first_half_ += sample;
        ++count_;
        sum_ += sample;
        const double luminance = luminance_of(sample);
        const double before = luminance - mean_;
        mean_ += before / count_;
        squares_ += before * (luminance - mean_);
    }

    std::uint32_t count() const { return count_; }
    Rgb mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : Rgb(0.0); }

    /// The mean of every second sample from the first on, or (1) from the second; of none: of all.
    Rgb half(int number) const {
        const std::uint32_t first = (count_ + 1) / 2;
        if (count_ < 2) return mean();
        return number == 0 ? first_half_ / static_cast<double>(first)
                           : (sum_ - first_half_) / static_cast<double>(count_ - first);
    }

    /// The standard error of the mean as the film shows it: in steps of 8 bits. Requires two samples.
    double error_255(const Film& film) const {
        const double error = std::sqrt(squares_ / (count_ - 1.0) / count_);
        const auto shown = [&](double luminance) { return 255 * developed(luminance, film); };
        return 0.5 * (shown(mean_ + error) - shown(std::max(mean_ - error, 0.0)));
    }

  private:
    static double luminance_of(const Rgb& rgb) { return glm::dot(rgb, Rgb(0.2126, 0.7152, 0.0722)); }

    std::uint32_t count_ = 0;
    Rgb sum_{0.0}, first_half_{0.0};
    double mean_ = 0, squares_ = 0;
};

} // namespace graftal
