#include "runtime/trace/pixel_features.h"

#include <cmath>

#include <glm/common.hpp>

#include "runtime/trace/pixel_filter.h"

namespace graftal {

PixelFeatures features_of(const AovSample& sample, const Camera& camera, const Rgb& light) {
    if (!sample.met) return {};
    PixelFeatures features{1};
    for (int c = 0; c < 3; ++c) {
        features[static_cast<std::size_t>(1 + c)] = static_cast<float>(sample.albedo[c]);
        features[static_cast<std::size_t>(4 + c)] = static_cast<float>(sample.normal[c]);
    }
    const auto finite = [](double value) {
        const auto one = static_cast<float>(value);
        return std::isfinite(one) ? one : 0;
    };
    // Nearness is linear in the picture: on a plane, and where pixels mix.
    features[near_feature] = finite(camera.orthographic ? -sample.depth : 1 / sample.depth);
    features[light_feature] = finite((light.x + light.y + light.z) / 3);
    return features;
}

FeatureSums::FeatureSums(const Tile& tile) : tile_(tile), sums_(tile.pixels()), weights_(tile.pixels()) {}

std::size_t FeatureSums::index(int x, int y) const {
    return static_cast<std::size_t>(y - tile_.y) * static_cast<std::size_t>(tile_.width) +
           static_cast<std::size_t>(x - tile_.x);
}

void FeatureSums::add(const glm::dvec2& place, const PixelFeatures& features) {
    const glm::ivec2 first = glm::ivec2(glm::floor(place)) - 1;
    const Tile around = common({first.x, first.y, 3, 3}, tile_);
    std::array<float, 3> across{};
    for (std::size_t i = 0; i < across.size(); ++i)
        across[i] = static_cast<float>(PixelFilter::weight(place.x - first.x - static_cast<double>(i) - 0.5));
    for (int y = around.y; y < around.y + around.height; ++y) {
        const auto down = static_cast<float>(PixelFilter::weight(place.y - y - 0.5));
        for (int x = around.x; x < around.x + around.width; ++x) {
            const float weight = across[static_cast<std::size_t>(x - first.x)] * down;
            const std::size_t i = index(x, y);
            weights_[i] += weight;
            for (std::size_t n = 0; n < features.size(); ++n)
                sums_[i][n] += weight * features[n];
        }
    }
}

PixelFeatures FeatureSums::mean(int x, int y) const {
    PixelFeatures mean = sums_[index(x, y)];
    const float weight = weights_[index(x, y)];
    for (float& value : mean)
        value = weight > 0 ? value / weight : 0;
    return mean;
}

} // namespace graftal
