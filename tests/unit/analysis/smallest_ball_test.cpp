#include "compiler/analysis/smallest_ball.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(SmallestBall, HoldsAllAndIsTheSmallest) {
    EXPECT_TRUE(smallest_ball({}).empty());
    const std::vector<Ball> one{{{1, 2, 3}, 4}};
    EXPECT_EQ(smallest_ball(one), one.front());
    const std::vector<Ball> inner{{{1, 0, 0}, 1}, {{0, 0, 0}, 5}, {{0, 0, 0}, 5}};
    EXPECT_NEAR(smallest_ball(inner).radius, 5, 1e-12);
    const std::vector<Ball> two{{{-3, 0, 0}, 1}, {{4, 0, 0}, 2}};
    EXPECT_NEAR(smallest_ball(two).radius, 5, 1e-9);
    EXPECT_NEAR(smallest_ball(two).centre.x, 1, 1e-9);
    std::vector<Ball> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({Vec3(i & 1, i >> 1 & 1, i >> 2 & 1), 0});
    EXPECT_NEAR(smallest_ball(corners).radius, std::sqrt(.75), 1e-9);
}

TEST(SmallestBall, IsLocallySmallestOnRandomBalls) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (int round = 0; round < 300; ++round) {
        std::vector<Ball> balls;
        for (int i = 0; i < 2 + round % 30; ++i)
            balls.push_back({{normal(random), normal(random), round % 3 == 0 ? 0 : normal(random)},
                             round % 2 == 0 ? 0 : std::abs(normal(random))});
        const Ball found = smallest_ball(balls);
        const auto needed = [&](Vec3 centre) {
            double radius = 0;
            for (const Ball& ball : balls)
                radius = std::max(radius, glm::length(ball.centre - centre) + ball.radius);
            return radius;
        };
        EXPECT_GE(found.radius, needed(found.centre) * (1 - 1e-15));
        for (int i = 0; i < 50; ++i) { // the needed radius is convex in the centre
            const Vec3 step(normal(random), normal(random), normal(random));
            EXPECT_GE(needed(found.centre + 1e-4 * step), found.radius * (1 - 1e-8));
        }
    }
}

} // namespace
} // namespace graftal
