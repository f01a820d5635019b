#pragma once

#include <cstdint>
#include <vector>

namespace graftal {

/// Samples as a file stores them, row by row, top first, channels together. Integer files give
/// value / largest value in [0, 1]; nothing is converted between colour spaces, and alpha stays straight
/// in PNG.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0; ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha
    std::vector<float> pixels;

    bool operator==(const Image&) const = default;
};

/// The meaning of a picture's samples, and the bits that they keep in a PNG. EXR files keep 32-bit floats
/// and are linear by definition.
enum class SampleFormat {
    srgb8,    ///< 8 bit, sRGB encoded: for people
    srgb16,   ///< 16 bit, sRGB encoded: for prints, and for programs that work on the picture
    linear16, ///< 16 bit, linear light (gamma 1 in the file): for numbers
};

/// The number that a PNG stores for 1.
inline int largest_level(SampleFormat format) {
    return format == SampleFormat::srgb8 ? 255 : 65535;
}

/// A linear value as sRGB encodes it (IEC 61966-2-1); clamped to [0, 1], 0 for NaN.
float srgb_encoded(float linear);

/// The level of a sample in a PNG: largest * sample, rounded, halves up; clamped, 0 for NaN. Adding 0.5
/// would round a float just below a half up as well.
std::uint32_t level_of(float sample, int largest);
std::uint8_t level8_of(float sample);

/// Distances of two pictures. The samples a_i, b_i, i = 1..N, are those of all pixels and channels
/// (a grey picture counts as RGB, a missing alpha as 1). With d_i = |a_i - b_i|:
///   max = max d_i,   mean = (1/N) sum d_i,   rms = sqrt((1/N) sum d_i^2).
/// p99 is the least number that 99 of 100 pixels do not exceed, each by its largest d_i.
/// Samples that are both NaN, or equal infinities, agree; any other pair with one of them is infinitely
/// apart.
struct ImageDifference {
    bool same_size = true; ///< else nothing below is set
    double max = 0;
    double mean = 0;
    double rms = 0;
    double p99 = 0;
    std::uint64_t over_threshold = 0; ///< pixels with a d_i > threshold
    std::uint64_t differing = 0;      ///< pixels with a d_i > 0
    std::uint64_t pixels = 0;
};

ImageDifference compare_images(const Image& a, const Image& b, double threshold = 0);

} // namespace graftal
