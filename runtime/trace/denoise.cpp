#include "runtime/trace/denoise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>

#include <Eigen/Core>

#include "compiler/support/check.h"
#include "runtime/image/develop.h"

namespace graftal {

namespace {

constexpr int feature_count = static_cast<int>(std::tuple_size_v<PixelFeatures>);
constexpr int channels = 6; ///< three of each half

constexpr int cell_px = 2;                ///< side of the squares that windows are made of
constexpr std::array<int, 2> radii{1, 2}; ///< of the windows, in cells besides the middle one
constexpr int error_radius_px = 4;        ///< over which errors are averaged
constexpr int near_px = 2;                ///< within which samples bound the light of a pixel
constexpr int tile_px = 96;
constexpr int halo_px = cell_px * (2 * radii.back() + 1) + error_radius_px;
static_assert(tile_px % cell_px == 0 && halo_px % cell_px == 0); // tiles have cells in common

/// Variance that each feature is taken to have besides its own, as a share and as a value: a window whose
/// features do not differ says nothing about them.
constexpr float ridge_share = 1e-3f, ridge = 1e-5f;

/// Light beyond which a pixel counts as one of this: squares of more are no numbers.
constexpr float most_light = 1e12f;

using Features = Eigen::Matrix<float, feature_count, 1>;
using Slopes = Eigen::Matrix<float, feature_count, channels>;
using PixelLight = Eigen::Matrix<float, 1, channels>;
using Square = Eigen::Matrix<float, feature_count, feature_count>;

/// Light as a linear function of features.
struct Fit {
    Slopes slopes;
    PixelLight level;
};

/// The sums that a fit needs, over the pixels of a window that have samples.
struct Moments {
    float weight; ///< number of these pixels, a pixel of the window
    Features feature;
    PixelLight light;
    Square feature_feature;
    Slopes feature_light;
};

/// A rectangle of values that are arrays of floats.
template<class Value> class Field {
  public:
    Field(int width, int height)
        : width_(width), values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
          height_(height) {}

    Value& at(int x, int y) {
        return values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x)];
    }
    int width() const { return width_; }
    int height() const { return height_; }

    /// Replaces each value by the mean over a square; at the sides over what there is of it.
    void average(int radius) {
        std::vector<Value> line(static_cast<std::size_t>(std::max(width_, height_)));
        for (int y = 0; y < height_; ++y)
            average_line(&at(0, y), 1, width_, radius, line);
        for (int x = 0; x < width_; ++x)
            average_line(&at(x, 0), width_, height_, radius, line);
    }

  private:
    static constexpr std::size_t floats = sizeof(Value) / sizeof(float);
    static std::span<float, floats> floats_of(Value& value) {
        return std::span<float, floats>(reinterpret_cast<float*>(&value), floats);
    }

    static void average_line(Value* first, int step, int count, int radius, std::vector<Value>& line) {
        for (int i = 0; i < count; ++i)
            line[static_cast<std::size_t>(i)] = first[static_cast<std::ptrdiff_t>(i) * step];
        // Each sum by itself: what is subtracted from a running one leaves the rounding of a bright pixel to
        // all that come after it.
        for (int i = 0; i < count; ++i) {
            const int begin = std::max(0, i - radius), end = std::min(count, i + radius + 1);
            std::array<float, floats> sum{};
            for (int k = begin; k < end; ++k) {
                const auto one = floats_of(line[static_cast<std::size_t>(k)]);
                for (std::size_t n = 0; n < floats; ++n)
                    sum[n] += one[n];
            }
            const auto to = floats_of(first[static_cast<std::ptrdiff_t>(i) * step]);
            const float share = 1.0f / static_cast<float>(end - begin);
            for (std::size_t n = 0; n < floats; ++n)
                to[n] = share * sum[n];
        }
    }

    int width_;
    std::vector<Value> values_;
    int height_;
};

// Eigen's sums of products depend on the instruction set; these have one order on all machines.

PixelLight product(const Features& features, const Slopes& slopes) {
    PixelLight sum = features[0] * slopes.row(0);
    for (int k = 1; k < feature_count; ++k)
        sum += features[k] * slopes.row(k);
    return sum;
}

/// The solution of a x = b by Cholesky's decomposition; not finite where `a` is not positive definite.
Slopes solved(Square a, Slopes b) {
    for (int j = 0; j < feature_count; ++j) {
        for (int k = 0; k < j; ++k)
            for (int i = j; i < feature_count; ++i)
                a(i, j) -= a(i, k) * a(j, k);
        const float diagonal = std::sqrt(a(j, j));
        for (int i = j; i < feature_count; ++i)
            a(i, j) /= diagonal;
    }
    for (int j = 0; j < feature_count; ++j) {
        for (int k = 0; k < j; ++k)
            b.row(j) -= a(j, k) * b.row(k);
        b.row(j) /= a(j, j);
    }
    for (int j = feature_count; j-- > 0;) {
        for (int k = j + 1; k < feature_count; ++k)
            b.row(j) -= a(k, j) * b.row(k);
        b.row(j) /= a(j, j);
    }
    return b;
}

Fit fit_of(const Moments& sum) {
    if (!(sum.weight > 0)) return {Slopes::Zero(), PixelLight::Zero()};
    const float share = 1 / sum.weight;
    const Features feature = share * sum.feature;
    const PixelLight light = share * sum.light;
    Square covariance = share * sum.feature_feature - feature * feature.transpose();
    covariance.diagonal() = (1 + ridge_share) * covariance.diagonal().cwiseMax(0) + Features::Constant(ridge);
    const Slopes slopes = solved(covariance, share * sum.feature_light - feature * light);
    if (!slopes.allFinite()) return {Slopes::Zero(), light};
    return {slopes, light - product(feature, slopes)};
}

class TileDenoiser {
  public:
    TileDenoiser(const std::vector<NoiseMeter>& samples, const std::vector<PixelFeatures>& features,
                 int width, int height, const Film& film)
        : samples_(samples), features_(features), width_(width), height_(height), film_(film) {
        scales_.fill(1);
        for (const std::size_t n : {near_feature, light_feature})
            scales_[n] = scale_of(n);
    }

    void run(int left, int top, Denoised& result) const {
        const int x0 = std::max(0, left - halo_px), y0 = std::max(0, top - halo_px);
        const int w = std::min(width_, left + tile_px + halo_px) - x0;
        const int h = std::min(height_, top + tile_px + halo_px) - y0;
        Field<PixelLight> halves(w, h);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                halves.at(x, y) = halves_of(samples_[index(x0 + x, y0 + y)]);
        Field<Range> ranges = ranges_of(x0, y0, halves);
        const Field<Moments> cells = cells_of(x0, y0, halves);
        std::vector<Estimate> estimates;
        for (const int radius : radii)
            estimates.push_back(estimate(x0, y0, cells, halves, radius));
        for (int y = top; y < std::min(height_, top + tile_px); ++y)
            for (int x = left; x < std::min(width_, left + tile_px); ++x)
                choose(index(x, y), x - x0, y - y0, estimates, ranges.at(x - x0, y - y0), result);
    }

  private:
    /// Squared errors as the film shows them: of an estimate, and of the mean of the samples.
    struct Errors {
        float weight; ///< of pixels that tell something
        float of_estimate, of_mean;
    };
    /// The light of samples near a pixel. Features that no window has seen lead estimates beyond it.
    struct Range {
        Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
        Eigen::Array3f high = -low;

        void include(const Range& other) {
            low = low.min(other.low);
            high = high.max(other.high);
        }
        Eigen::Array3f nearest(const Eigen::Array3f& light) const {
            return (low <= high).all() ? Eigen::Array3f(light.max(low).min(high)) : light;
        }
    };
    struct Estimate {
        Field<Eigen::Vector3f> light;
        Field<Errors> errors;
    };

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    /// Makes a feature that has no scale of its own 1 in the mean; 0 where none is, or all are next to
    /// nothing.
    float scale_of(std::size_t feature) const {
        double sum = 0, covered = 0;
        for (const PixelFeatures& one : features_) {
            covered += static_cast<double>(one[0]);
            sum += std::abs(static_cast<double>(one[feature]));
        }
        const double scale = covered / sum;
        return scale <= std::numeric_limits<float>::max() ? static_cast<float>(scale) : 0;
    }

    Features features_at(int x, int y) const {
        return Features(features_[index(x, y)].data()).cwiseProduct(Features(scales_.data()));
    }

    bool has_halves(int x, int y) const { return samples_[index(x, y)].count() >= 2; }

    static PixelLight halves_of(const NoiseMeter& meter) {
        PixelLight both;
        for (int c = 0; c < 3; ++c) {
            both[c] = std::min(static_cast<float>(meter.half(0)[c]), most_light);
            both[3 + c] = std::min(static_cast<float>(meter.half(1)[c]), most_light);
        }
        return both;
    }

    Field<Range> ranges_of(int x0, int y0, Field<PixelLight>& halves) const {
        const int w = halves.width(), h = halves.height();
        Field<Range> across(w, h), both(w, h);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                for (int i = std::max(0, x - near_px); i <= std::min(w - 1, x + near_px); ++i) {
                    if (samples_[index(x0 + i, y0 + y)].count() == 0) continue;
                    const Eigen::Array<float, channels, 1> light = halves.at(i, y).transpose();
                    across.at(x, y).include({light.head<3>(), light.head<3>()});
                    across.at(x, y).include({light.tail<3>(), light.tail<3>()});
                }
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                for (int i = std::max(0, y - near_px); i <= std::min(h - 1, y + near_px); ++i)
                    both.at(x, y).include(across.at(x, i));
        return both;
    }

    Field<Moments> cells_of(int x0, int y0, Field<PixelLight>& halves) const {
        const int w = halves.width(), h = halves.height();
        Field<Moments> cells((w + cell_px - 1) / cell_px, (h + cell_px - 1) / cell_px);
        for (int cell_y = 0; cell_y < cells.height(); ++cell_y)
            for (int cell_x = 0; cell_x < cells.width(); ++cell_x) {
                const int left = cell_x * cell_px, top = cell_y * cell_px;
                const int right = std::min(left + cell_px, w), below = std::min(top + cell_px, h);
                const float share = 1.0f / static_cast<float>((right - left) * (below - top));
                Moments& sum = cells.at(cell_x, cell_y);
                sum = {0, Features::Zero(), PixelLight::Zero(), Square::Zero(), Slopes::Zero()};
                for (int y = top; y < below; ++y)
                    for (int x = left; x < right; ++x) {
                        if (!has_halves(x0 + x, y0 + y)) continue;
                        sum.weight += share;
                        const Features f = features_at(x0 + x, y0 + y), weighted = share * f;
                        const PixelLight& light = halves.at(x, y);
                        sum.feature += weighted;
                        sum.light += share * light;
                        sum.feature_feature += weighted * f.transpose();
                        sum.feature_light += weighted * light;
                    }
            }
        return cells;
    }

    Estimate estimate(int x0, int y0, const Field<Moments>& cells, Field<PixelLight>& halves,
                      int radius) const {
        const int w = halves.width(), h = halves.height();
        Field<Moments> moments = cells;
        moments.average(radius);
        Field<Fit> fits(moments.width(), moments.height());
        for (int y = 0; y < fits.height(); ++y)
            for (int x = 0; x < fits.width(); ++x)
                fits.at(x, y) = fit_of(moments.at(x, y));
        fits.average(radius);
        Estimate estimate{{w, h}, {w, h}};
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const PixelLight light = light_at(x, y, fits, features_at(x0 + x, y0 + y));
                estimate.light.at(x, y) = 0.5f * (light.head<3>() + light.tail<3>()).transpose();
                estimate.errors.at(x, y) =
                    has_halves(x0 + x, y0 + y) ? errors_of(light, halves.at(x, y)) : Errors{0, 0, 0};
            }
        estimate.errors.average(error_radius_px);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                Errors& errors = estimate.errors.at(x, y);
                const float share = errors.weight > 0 ? 1 / errors.weight : 0;
                errors = {1, share * errors.of_estimate, share * errors.of_mean};
            }
        return estimate;
    }

    /// The light that the fits around a pixel give its features.
    static PixelLight light_at(int x, int y, Field<Fit>& fits, const Features& features) {
        const auto place = [](int pixel, int cells, int& cell, float& beyond) {
            const float at = (static_cast<float>(pixel) + 0.5f) / cell_px - 0.5f;
            cell = std::clamp(static_cast<int>(std::floor(at)), 0, std::max(cells - 2, 0));
            beyond = std::clamp(at - static_cast<float>(cell), 0.0f, 1.0f);
            return std::min(cell + 1, cells - 1);
        };
        int left = 0, top = 0;
        float across = 0, down = 0;
        const int right = place(x, fits.width(), left, across), below = place(y, fits.height(), top, down);
        const auto by = [&](int column, int row, float weight) -> PixelLight {
            const Fit& fit = fits.at(column, row);
            return weight * (fit.level + product(features, fit.slopes));
        };
        const PixelLight light = by(left, top, (1 - across) * (1 - down)) +
                                 by(right, top, across * (1 - down)) + by(left, below, (1 - across) * down) +
                                 by(right, below, across * down);
        return light.cwiseMax(0);
    }

    /// Errors of one pixel, which tell something as means over many.
    Errors errors_of(const PixelLight& estimated, const PixelLight& sampled) const {
        Errors errors{1, 0, 0};
        for (int c = 0; c < 3; ++c) {
            const float slope = shown_slope(0.5f * (estimated[c] + estimated[3 + c]));
            const float first = slope * (estimated[c] - sampled[3 + c]);
            const float second = slope * (estimated[3 + c] - sampled[c]);
            const float apart = slope * (sampled[c] - sampled[3 + c]);
            errors.of_estimate += (0.5f * (first * first + second * second) - 0.5f * apart * apart) / 3;
            errors.of_mean += apart * apart / (4 * 3);
        }
        return errors;
    }

    /// How fast the shown level grows with light there, in 255ths.
    float shown_slope(float light) const {
        const double at = std::max(0.0, static_cast<double>(light)), step = 1e-3 + 1e-2 * at;
        return static_cast<float>(255 * (developed(at + step, film_) - developed(at, film_)) / step);
    }

    /// Mixes the best estimate and the mean so that the error of both is least, were they independent.
    /// Without samples there is the estimate alone; where light is too bright for sums, the mean.
    void choose(std::size_t pixel, int x, int y, std::vector<Estimate>& estimates, const Range& range,
                Denoised& result) const {
        const NoiseMeter& meter = samples_[pixel];
        Estimate* best = &estimates.front();
        for (Estimate& one : estimates)
            if (one.errors.at(x, y).of_estimate < best->errors.at(x, y).of_estimate) best = &one;
        const Errors errors = best->errors.at(x, y);
        const float mean_error = std::max(errors.of_mean, 0.0f);
        const float error = std::max(errors.of_estimate, 0.02f * mean_error);
        float share = mean_error > 0 && meter.count() >= 2 ? mean_error / (mean_error + error) : 0;
        if (meter.count() == 0) share = 1;
        const float left = std::sqrt(share * share * error + (1 - share) * (1 - share) * mean_error);
        result.errors_255[pixel] = std::isfinite(left) ? left : 255;
        const Eigen::Array3f light = range.nearest(best->light.at(x, y).array());
        for (int c = 0; c < 3; ++c) {
            const auto mean = static_cast<float>(meter.mean()[c]);
            const float mixed = mean + share * (light[c] - mean);
            result.picture.pixels[3 * pixel + static_cast<std::size_t>(c)] =
                std::isfinite(mixed) ? mixed : mean;
        }
    }

    const std::vector<NoiseMeter>& samples_;
    const std::vector<PixelFeatures>& features_;
    int width_, height_;
    const Film& film_;
    PixelFeatures scales_;
};

} // namespace

double Denoised::mean_error_255() const {
    return std::accumulate(errors_255.begin(), errors_255.end(), 0.0) /
           std::max<double>(1, static_cast<double>(errors_255.size()));
}

Denoised denoise(const std::vector<NoiseMeter>& samples, const std::vector<PixelFeatures>& features,
                 int width, int height, const Film& film, const Workers& workers, const CancelFlag& cancel) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    GRAFTAL_CHECK(samples.size() == pixels && features.size() == pixels, "denoise: one of each a pixel");
    Denoised result{{width, height, 3, std::vector<float>(3 * pixels)}, std::vector<float>(pixels)};
    const int across = (width + tile_px - 1) / tile_px, down = (height + tile_px - 1) / tile_px;
    const TileDenoiser denoiser(samples, features, width, height, film);
    workers.for_each(static_cast<std::uint64_t>(across) * static_cast<std::uint64_t>(down),
                     [&](int, std::uint64_t number) {
                         if (cancel.raised()) return;
                         const int tile = static_cast<int>(number);
                         denoiser.run(tile % across * tile_px, tile / across * tile_px, result);
                     });
    return result;
}

} // namespace graftal
