#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/image/image.h"

namespace graftal {

namespace {

/// Reads a picture as RGBA, whatever its channels.
class RgbaView {
  public:
    explicit RgbaView(const Image& image) : image_(image), grey_(image.channels <= 2) {}

    double sample(std::size_t pixel, int channel) const {
        const auto channels = static_cast<std::size_t>(image_.channels);
        if (channel == 3) return has_alpha() ? image_.pixels[pixel * channels + channels - 1] : 1.0;
        return image_.pixels[pixel * channels + (grey_ ? 0 : static_cast<std::size_t>(channel))];
    }
    bool has_alpha() const { return image_.channels == 2 || image_.channels == 4; }

  private:
    const Image& image_;
    bool grey_;
};

double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    const double d = std::abs(a - b);
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

} // namespace

ImageDifference compare_images(const Image& a, const Image& b, double threshold) {
    ImageDifference result;
    result.same_size = a.width == b.width && a.height == b.height;
    if (!result.same_size) return result;

    const RgbaView left(a), right(b);
    const int channels = left.has_alpha() || right.has_alpha() ? 4 : 3;
    result.pixels = static_cast<std::uint64_t>(a.width) * static_cast<std::uint64_t>(a.height);
    double sum = 0, sum_of_squares = 0;
    std::vector<double> largest_of_pixel;
    largest_of_pixel.reserve(result.pixels);
    for (std::uint64_t pixel = 0; pixel < result.pixels; ++pixel) {
        double largest = 0;
        for (int channel = 0; channel < channels; ++channel) {
            const double d = distance(left.sample(pixel, channel), right.sample(pixel, channel));
            largest = std::max(largest, d);
            sum += d;
            sum_of_squares += d * d;
        }
        result.max = std::max(result.max, largest);
        result.over_threshold += largest > threshold;
        result.differing += largest > 0;
        largest_of_pixel.push_back(largest);
    }
    if (result.pixels == 0) return result;
    const double samples = static_cast<double>(result.pixels) * channels;
    result.mean = sum / samples;
    result.rms = std::sqrt(sum_of_squares / samples);
    const auto rank =
        largest_of_pixel.begin() + static_cast<std::ptrdiff_t>((result.pixels * 99 + 99) / 100 - 1);
    std::nth_element(largest_of_pixel.begin(), rank, largest_of_pixel.end());
    result.p99 = *rank;
    return result;
}

} // namespace graftal
