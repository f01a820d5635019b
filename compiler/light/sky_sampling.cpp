#include "compiler/light/sky_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compiler/light/longitude.h"

namespace graftal {

namespace {

/// The least excess of light over the mean, as a share of it: rounding of an even sky is not bright.
constexpr double least_excess = 1e-4;

/// The number between -1 and 1 that one in [0, 1) chooses, with a density of 1 - |x|.
double tent(double place) {
    return place < 0.5 ? std::sqrt(2 * place) - 1 : 1 - std::sqrt(2 * (1 - place));
}

/// The first entry above the place, and how far the place is on the way to it from the one before.
template<typename Number>
std::pair<std::size_t, double> entry_at(std::span<const Number> sums, double place) {
    const auto found = std::min(std::ranges::upper_bound(sums, place) - sums.begin(), std::ssize(sums) - 1);
    const auto entry = static_cast<std::size_t>(found);
    const double begin = entry > 0 ? sums[entry - 1] : 0;
    return {entry, std::clamp((place - begin) / (sums[entry] - begin), 0.0, 1.0)};
}

} // namespace

SkySampling::SkySampling(int width, int height, std::span<const float> light)
    : width_(static_cast<std::size_t>(width)), height_(static_cast<std::size_t>(height)), rows_(height_),
      columns_(light.size()) {
    const auto size = [&](std::size_t row) {
        return std::sin(std::numbers::pi * (static_cast<double>(row) + 0.5) / static_cast<double>(height_));
    };
    double mean = 0, sphere = 0;
    for (std::size_t row = 0; row < height_; ++row) {
        for (std::size_t x = 0; x < width_; ++x)
            mean += size(row) * light[row * width_ + x];
        sphere += size(row) * static_cast<double>(width_);
    }
    const double dark = (1 + least_excess) * mean / sphere;
    double whole = 0;
    std::vector<double> sums(width_);
    for (std::size_t row = 0; row < height_; ++row) {
        double sum = 0;
        for (std::size_t x = 0; x < width_; ++x)
            sums[x] = sum += std::max(light[row * width_ + x] - dark, 0.0);
        for (std::size_t x = 0; x < width_; ++x)
            columns_[row * width_ + x] = sum > 0 ? static_cast<float>(sums[x] / sum) : 0;
        rows_[row] = whole += size(row) * sum;
    }
    any_ = whole > 0;
    for (double& row : rows_)
        row = any_ ? row / whole : 0;
}

Vec3 SkySampling::direction(glm::dvec2 place) const {
    const auto [row, down] = entry_at<double>(rows_, place.y);
    const auto [column, right] = entry_at<float>(std::span(columns_).subspan(row * width_, width_), place.x);
    const double u = (static_cast<double>(column) + 0.5 + tent(right)) / static_cast<double>(width_);
    double v = std::abs((static_cast<double>(row) + 0.5 + tent(down)) / static_cast<double>(height_));
    if (v > 1) v = 2 - v; // as at the other pole, back into the row
    return direction_at(u, std::cos(std::numbers::pi * v));
}

double SkySampling::density(Vec3 direction) const {
    if (!any_) return 0;
    const TexelMix mix(place_of(direction), static_cast<int>(width_), static_cast<int>(height_));
    const auto chance = [&](int row) {
        const auto r = static_cast<std::size_t>(row);
        return row_chance(r) * ((1 - mix.right) * column_chance(r, static_cast<std::size_t>(mix.x0)) +
                                mix.right * column_chance(r, static_cast<std::size_t>(mix.x1)));
    };
    const double of_texel = (1 - mix.down) * chance(mix.y0) + mix.down * chance(mix.y1);
    constexpr double least_sine = 1e-12;
    const double sine = std::max(std::hypot(direction.x, direction.z), least_sine);
    return of_texel * static_cast<double>(width_ * height_) /
           (2 * std::numbers::pi * std::numbers::pi * sine);
}

} // namespace graftal
