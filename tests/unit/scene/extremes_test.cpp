#include "compiler/scene/extremes.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

double farthest(const std::vector<Vec3>& points, Vec3 direction) {
    double most = -1e300;
    for (const Vec3& point : points)
        most = std::max(most, glm::dot(point, direction));
    return most;
}

std::vector<Vec3> random_points(std::mt19937_64& random, int count, Vec3 centre) {
    std::normal_distribution<double> normal;
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i)
        points.push_back(centre + glm::normalize(Vec3(normal(random), normal(random), normal(random))));
    return points;
}

TEST(Extremes, FewPointsStandForMany) {
    std::mt19937_64 random(1);
    Extremes extremes;
    std::vector<Vec3> all;
    for (int set = 0; set < 20; ++set) {
        const std::vector<Vec3> points = random_points(random, 2000, {0.1 * set, 0, 0});
        all.insert(all.end(), points.begin(), points.end());
        extremes.include(points);
    }
    const std::vector<Vec3> few = extremes.points();
    EXPECT_LE(few.size(), 1000u);
    for (const Vec3& direction : random_points(random, 500, Vec3(0.0))) {
        EXPECT_LE(farthest(few, direction), farthest(all, direction));
        EXPECT_GE(farthest(few, direction), farthest(all, direction) - 0.003 * 4);
    }
}

TEST(Extremes, NothingGivesNothing) {
    Extremes extremes;
    extremes.include({});
    EXPECT_TRUE(extremes.points().empty());
    extremes.include({Vec3(1, 2, 3)});
    EXPECT_EQ(extremes.points(), std::vector<Vec3>{Vec3(1, 2, 3)});
}

TEST(Extremes, RevolvedPointsHoldTheirCircles) {
    const Vec3 axis(5, 0, -2);
    const std::vector<Vec3> ring = revolved({{8, 1, 2}}, axis); // radius 5
    for (int degrees = 0; degrees < 360; ++degrees) {
        const Vec3 direction(std::sin(degrees), 0, std::cos(degrees));
        const double reached = farthest(ring, direction) - glm::dot(axis, direction);
        EXPECT_GE(reached, 5 - 1e-9);
        EXPECT_LE(reached, 5.01);
    }
    for (const Vec3& point : ring)
        EXPECT_EQ(point.y, 1);
}

} // namespace
} // namespace graftal
