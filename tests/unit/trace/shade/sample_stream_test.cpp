#include "runtime/trace/shade/sample_stream.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/trace/pixel_filter.h"

namespace graftal {
namespace {

/// The pair of that number of the first `count` samples of a pixel.
std::vector<glm::dvec2> pairs(std::uint64_t seed, int pair, std::uint32_t count) {
    std::vector<glm::dvec2> all;
    for (std::uint32_t i = 0; i < count; ++i) {
        SampleStream stream(seed, i);
        glm::dvec2 values(0.0);
        for (int k = 0; k <= pair; ++k)
            values = stream.next();
        all.push_back(values);
    }
    return all;
}

/// A (0, m, 2)-net in base 2: each box of area 1/64 of each shape holds one of 64 points.
TEST(SampleStream, EachPairOfEachPixelIsANet) {
    for (const std::uint64_t seed : {0ull, 1ull, 7ull << 32, ~0ull})
        for (const int pair : {0, 1, 5})
            for (int bits = 0; bits <= 6; ++bits) {
                std::set<std::pair<int, int>> boxes;
                for (const glm::dvec2 point : pairs(seed, pair, 64)) {
                    EXPECT_TRUE(point.x >= 0 && point.x < 1 && point.y >= 0 && point.y < 1);
                    boxes.emplace(static_cast<int>(std::ldexp(point.x, bits)),
                                  static_cast<int>(std::ldexp(point.y, 6 - bits)));
                }
                EXPECT_EQ(boxes.size(), 64u) << seed << " pair " << pair << " shape " << bits;
            }
}

TEST(SampleStream, PairsAndPixelsHaveNothingToDoWithEachOther) {
    const auto correlation = [](const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            sum += (a[i].x - 0.5) * (b[i].x - 0.5);
        return 12 * sum / static_cast<double>(a.size());
    };
    double most = 0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        most = std::max(most, std::abs(correlation(pairs(seed, 0, 256), pairs(seed, 1, 256))));
        most = std::max(most, std::abs(correlation(pairs(seed, 0, 256), pairs(seed + 1, 0, 256))));
    }
    EXPECT_LT(most, 0.3); // of 100 that are independent, about 4.5 / sqrt(256) at most
}

TEST(PixelFilter, IsAWindowOfThreePixels) {
    const PixelFilter filter;
    EXPECT_NEAR(filter.offset(0), -PixelFilter::radius_px, 1e-9);
    EXPECT_NEAR(filter.offset(0.5), 0, 1e-9);
    double before = -2, mean = 0, inside = 0;
    constexpr int count = 1000;
    for (int i = 0; i < count; ++i) {
        const double offset = filter.offset((i + 0.5) / count);
        EXPECT_GT(offset, before);
        before = offset;
        mean += offset / count;
        inside += std::abs(offset) < 0.5;
    }
    EXPECT_NEAR(mean, 0, 1e-9);
    EXPECT_GT(inside / count, 0.7) << "most of a pixel's light is from itself";
}

} // namespace
} // namespace graftal
