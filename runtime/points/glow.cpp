#include "runtime/points/glow.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr int channels = 3;
constexpr int fewest_pixels = 16; ///< of the coarsest level: light that goes farther would fog the picture

float& sample(Image& image, int x, int y, int channel) {
    return image.pixels[channels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(x)) +
                        static_cast<std::size_t>(channel)];
}

Image blank(int width, int height) {
    const std::size_t samples = channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {width, height, channels, std::vector<float>(samples)};
}

/// Means of two by two pixels; at an odd edge the last counts twice.
Image halved(Image& image) {
    Image half = blank((image.width + 1) / 2, (image.height + 1) / 2);
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x)
            for (int c = 0; c < channels; ++c) {
                const int right = std::min(2 * x + 1, image.width - 1);
                const int below = std::min(2 * y + 1, image.height - 1);
                sample(half, x, y, c) = (sample(image, 2 * x, 2 * y, c) + sample(image, right, 2 * y, c) +
                                         sample(image, 2 * x, below, c) + sample(image, right, below, c)) /
                                        4;
            }
    return half;
}

/// Two neighbours of a halved row or column, and the share of the second, for a place of the whole one.
struct Between {
    Between(int place, int count)
        : first(std::max((place - 1) / 2, 0)), second(std::min((place + 1) / 2, count - 1)),
          share(place % 2 == 0 ? 0.75f : 0.25f) {}

    int first, second;
    float share;
};

/// `target` += `factor` * `half`, which is half as large, linearly between its pixels.
void add_doubled(Image& target, Image& half, float factor) {
    for (int y = 0; y < target.height; ++y) {
        const Between row(y, half.height);
        for (int x = 0; x < target.width; ++x) {
            const Between column(x, half.width);
            for (int c = 0; c < channels; ++c) {
                const auto across = [&](int at) {
                    return (1 - column.share) * sample(half, column.first, at, c) +
                           column.share * sample(half, column.second, at, c);
                };
                sample(target, x, y, c) +=
                    factor * ((1 - row.share) * across(row.first) + row.share * across(row.second));
            }
        }
    }
}

} // namespace

void spread_glow(Image& light, double share) {
    GRAFTAL_CHECK(light.channels == channels, "glow");
    constexpr std::size_t first = 2; // a level of pixels that are 2^first times as large
    std::vector<Image> levels;
    levels.push_back(halved(light));
    while (std::max(levels.back().width, levels.back().height) > fewest_pixels)
        levels.push_back(halved(levels.back()));
    if (levels.size() < first) return;
    const std::size_t spread = levels.size() - first + 1;
    for (std::size_t i = levels.size() - 1; i-- > 0;) {
        if (i + 1 < first) std::fill(levels[i].pixels.begin(), levels[i].pixels.end(), 0.0f);
        add_doubled(levels[i], levels[i + 1], 1);
    }
    for (float& value : light.pixels)
        value *= static_cast<float>(1 - share);
    add_doubled(light, levels.front(), static_cast<float>(share) / static_cast<float>(spread));
}

} // namespace graftal
