#include "runtime/trace/pixel_features.h"

#include <limits>

#include <gtest/gtest.h>

#include "runtime/trace/pixel_filter.h"

namespace graftal {
namespace {

constexpr Tile tile{10, 20, 8, 6};

AovSample sample_at(double depth) {
    AovSample sample;
    sample.met = true;
    sample.depth = depth;
    sample.normal = {0, 0, 1};
    sample.albedo = {0.2, 0.4, 0.6};
    return sample;
}

/// Adds rays through a fine grid of the tile and a pixel around it.
template<class FeaturesAt> FeatureSums sums_of(const FeaturesAt& features_at) {
    FeatureSums sums(tile);
    for (double y = tile.y - 0.95; y < tile.y + tile.height + 1; y += 0.1)
        for (double x = tile.x - 0.95; x < tile.x + tile.width + 1; x += 0.1)
            sums.add({x, y}, features_at(x, y));
    return sums;
}

TEST(PixelFeatures, OfOneSurfaceAreItsOwn) {
    const PixelFeatures wall = features_of(sample_at(4), {}, Rgb(0.3, 0.6, 0.9));
    EXPECT_EQ(wall, (PixelFeatures{1, 0.2f, 0.4f, 0.6f, 0, 0, 1, 0.25f, 0.6f}));
    const FeatureSums sums = sums_of([&](double, double) { return wall; });
    for (int y = tile.y; y < tile.y + tile.height; ++y)
        for (int x = tile.x; x < tile.x + tile.width; ++x)
            for (std::size_t i = 0; i < wall.size(); ++i)
                EXPECT_NEAR(sums.mean(x, y)[i], wall[i], 1e-5);
}

/// An edge through a pixel's middle covers half of it, and the filter reaches into the next ones.
TEST(PixelFeatures, AtAnEdgeCountTheShareThatTheFilterSees) {
    const FeatureSums sums = sums_of(
        [](double x, double) { return x < 14.5 ? features_of(sample_at(1), {}, Rgb(0)) : PixelFeatures{}; });
    EXPECT_NEAR(sums.mean(14, 23)[0], 0.5, 0.01);
    EXPECT_NEAR(sums.mean(12, 23)[0], 1, 1e-5);
    EXPECT_NEAR(sums.mean(16, 23)[0], 0, 1e-5);
    EXPECT_GT(sums.mean(13, 23)[0], 0.9);
    EXPECT_LT(sums.mean(13, 23)[0], 1);
}

TEST(PixelFeatures, AreFinite) {
    EXPECT_EQ(features_of(sample_at(0), {}, Rgb(std::numeric_limits<double>::infinity())),
              (PixelFeatures{1, 0.2f, 0.4f, 0.6f, 0, 0, 1, 0, 0}));
    EXPECT_EQ(features_of({}, {}, Rgb(1)), PixelFeatures{});
    Camera parallel;
    parallel.orthographic = true;
    EXPECT_EQ(features_of(sample_at(-3), parallel, Rgb(0))[near_feature], 3);
}

/// The window is the density of the offsets that samples have.
TEST(PixelFilter, WeighsAsOftenAsSamplesFall) {
    const PixelFilter filter;
    for (const double u : {0.1, 0.3, 0.5, 0.8}) {
        const double density = 2e-3 / (filter.offset(u + 1e-3) - filter.offset(u - 1e-3));
        EXPECT_NEAR(density, PixelFilter::weight(filter.offset(u)) / (0.35875 * 2 * PixelFilter::radius_px),
                    0.01);
    }
}

} // namespace
} // namespace graftal
