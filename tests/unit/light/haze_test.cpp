#include "compiler/light/haze.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(Haze, FindsTheLengthOfEachShareOfItsLight) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const Haze haze{.distance = std::exp2(6 * unit(random)),
                        .base = unit(random),
                        .height = i % 2 ? INFINITY : std::exp2(4 * unit(random))};
        const Vec3 from(0, 3 * unit(random), 0);
        const Vec3 direction = glm::normalize(Vec3(1, 0.5 * unit(random), unit(random)));
        const double length = std::exp2(8 * unit(random)), share = 0.5 + 0.5 * unit(random);
        const double found = haze.length_of_share(from, direction, length, share);
        ASSERT_GE(found, 0);
        ASSERT_LE(found, length);
        ASSERT_NEAR(1 - haze.left_after(from, direction, found),
                    share * (1 - haze.left_after(from, direction, length)), 1e-9)
            << i;
    }
}

TEST(Haze, ScattersAsMuchAsItGetsAndMostlyOn) {
    constexpr int steps = 20000;
    double mean = 0;
    for (int i = 0; i < steps; ++i) {
        const double cosine = -1 + (2 * i + 1.0) / steps;
        mean += Haze::scattered({cosine, std::sqrt(1 - cosine * cosine), 0}, {3, 0, 0}) / steps;
    }
    EXPECT_NEAR(mean, 1, 1e-6);
    EXPECT_NEAR(Haze::scattered({1, 0, 0}, {1, 0, 0}), 10, 1e-9);
    EXPECT_NEAR(Haze::scattered({-1, 0, 0}, {1, 0, 0}), 0.15625, 1e-9);
}

} // namespace
} // namespace graftal
