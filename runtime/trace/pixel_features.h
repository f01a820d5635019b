#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "compiler/scene/scene.h"
#include "compiler/support/tint.h"
#include "runtime/trace/aovs.h"
#include "runtime/trace/tile.h"

namespace graftal {

/// The first surfaces behind a pixel as linear measures, so that a pixel that sees several shows their
/// mixture: coverage, and times it the colour (3), the normal (3), the nearness, and the light of lamps.
using PixelFeatures = std::array<float, 9>;
inline constexpr std::size_t near_feature = 7, light_feature = 8;

/// Features of one ray. `light`: of the lamps alone. All are finite.
PixelFeatures features_of(const AovSample& sample, const Camera& camera, const Rgb& light);

/// Features of the pixels of a tile: each ray counts for the nine pixels around it, by the filter of samples.
class FeatureSums {
  public:
    explicit FeatureSums(const Tile& tile);

    /// `place`: of the ray, in pixels of the picture.
    void add(const glm::dvec2& place, const PixelFeatures& features);
    PixelFeatures mean(int x, int y) const;

  private:
    std::size_t index(int x, int y) const;

    Tile tile_;
    std::vector<PixelFeatures> sums_;
    std::vector<float> weights_;
};

} // namespace graftal
