#include "compiler/support/stretch.h"

#include <cmath>
#include <random>

#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

/// Random directions, and half axes of these lengths.
Mat3 map_of(Vec3 sigma, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const auto direction = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    std::uniform_real_distribution<double> angle_deg(0, 360);
    const Mat3 left = Affine::rotate(direction(), angle_deg(random)).linear;
    const Mat3 right = Affine::rotate(direction(), angle_deg(random)).linear;
    const double mirror = random() % 2 ? 1 : -1;
    return left * Affine::scale({mirror * sigma.x, sigma.y, sigma.z}).linear * right;
}

constexpr Vec3 shapes[] = {{1, 1, 1},         {1, 1, 1e-3},       {1, 1e-3, 1e-3},  {1, 0.5, 1e-6},
                           {1, 1e-3, 1e-9},   {3, 2, 0},          {1, 1e-4, 0},     {1, 1e-7, 0},
                           {1, 0, 0},         {1, 1e-6, 1e-12},   {1e30, 1, 1e-30}, {2, 1.9, 1.9e-5},
                           {1e-60, 1e-61, 0}, {5e-8, 4e-8, 1e-14}};

TEST(Stretch, LargestIsThatOfTheDecomposition) {
    std::mt19937_64 random(1);
    for (const Vec3& sigma : shapes)
        for (int i = 0; i < 50; ++i) {
            const Mat3 map = map_of(sigma, random);
            const double largest = largest_stretch(map);
            EXPECT_NEAR(largest, norm(map), 1e-7 * norm(map)) << sigma.x << ' ' << sigma.y << ' ' << sigma.z;
            EXPECT_GE(most_stretch(map), (1 - 1e-12) * norm(map));
            EXPECT_LE(most_stretch(map), 1.8 * norm(map));
        }
}

TEST(Stretch, BoundsHoldTheSingularValues) {
    std::mt19937_64 random(2);
    for (const Vec3& sigma : shapes)
        for (int i = 0; i < 50; ++i) {
            const Mat3 map = map_of(sigma, random);
            const Vec3 most = most_singular_values(map);
            for (int k = 0; k < 3; ++k)
                EXPECT_GE(most[k], sigma[k] * (1 - 1e-6)) << k << " of " << sigma.x << ' ' << sigma.y;
            EXPECT_LE(most.x, 1.8 * sigma.x);
            EXPECT_LE(most.y, 3.01 * sigma.y + 1e-14 * sigma.x);
            // Of a line nobody knows how thick it is across its width.
            const bool line = !(sigma.y > 1e-3 * sigma.x);
            EXPECT_LE(most.z, line ? most.y : 3.01 * sigma.z + 1e-12 * sigma.x);
        }
}

TEST(Stretch, FlatnessIsWhatTheDecompositionSays) {
    std::mt19937_64 random(3);
    for (const Vec3& sigma : shapes)
        for (const double share : {1e-12, 1e-9, 1e-6, 1e-5, 1e-2}) {
            const double flatness = sigma.z / sigma.x;
            if (std::abs(flatness - share) <= 1e-3 * share) continue; // rounding decides
            for (int i = 0; i < 20; ++i) {
                const Mat3 map = map_of(sigma, random);
                const double found = flatness_over(share, map);
                EXPECT_EQ(found > 0, flatness > share) << share << " of " << flatness;
                EXPECT_LE(found, flatness * (1 + 1e-3));
                EXPECT_TRUE(found == 0 || found > share);
                EXPECT_EQ(is_singular({map, {}}, share), !(flatness > share));
            }
        }
}

TEST(Stretch, AFlatMapIsThickenedAlongItsNormalOnly) {
    std::mt19937_64 random(4);
    int flat_maps = 0;
    for (const Vec3& sigma : shapes)
        for (int i = 0; i < 20; ++i) {
            const Mat3 map = map_of(sigma, random);
            const std::optional<FlatMap> flat = flat_map(map);
            if (!flat) continue;
            ++flat_maps;
            for (int k = 0; k < 2; ++k)
                EXPECT_NEAR(flat->sigma[k], sigma[k], 1e-9 * sigma[k]);
            EXPECT_NEAR(flat->sigma.z, sigma.z, 1e-9 * sigma.z + 1e-15 * sigma.x * sigma.x / sigma.y);
            const double thickness = 0.5 * sigma.y;
            const Vec3 thick = singular_values(map + (thickness - flat->sigma.z) * flat->thickening);
            EXPECT_NEAR(thick.x, sigma.x, 1e-5 * sigma.x);
            EXPECT_NEAR(thick.y, sigma.y, 1e-5 * sigma.x);
            EXPECT_NEAR(thick.z, thickness, 1e-5 * sigma.x);
        }
    EXPECT_GE(flat_maps, 80);
}

/// Leaves of models that crush space to lines asked for a decomposition each.
TEST(Stretch, LinesNeedNoDecomposition) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> exponent(-16, 0);
    int lines = 0;
    for (int i = 0; i < 2000; ++i) {
        const double middle = std::pow(10.0, exponent(random)),
                     least = middle * std::pow(10.0, exponent(random));
        const std::optional<Vec3> line = line_values(map_of({1, middle, least}, random));
        if (!line) {
            EXPECT_GT(middle, 0.7e-4);
            continue;
        }
        ++lines;
        EXPECT_NEAR(line->x, 1, 1e-7);
        EXPECT_GE(line->y, middle * (1 - 1e-6) - 1e-15);
        EXPECT_LE(line->y, std::sqrt(2.0) * middle * (1 + 1e-6) + 1e-14);
        if (middle > 1e-8) {
            EXPECT_GE(line->z, least / std::sqrt(2.0) - 1e-14 / middle);
            EXPECT_LE(line->z, least + 1e-14 / middle);
        }
    }
    EXPECT_GT(lines, 1000);
    EXPECT_FALSE(line_values(Mat3(1.0)));
    EXPECT_FALSE(line_values(Mat3(0.0)));
}

TEST(Stretch, OfNothingIsNothing) {
    EXPECT_EQ(flatness_over(1e-6, Mat3(0.0)), 0);
    EXPECT_EQ(largest_stretch(Mat3(0.0)), 0);
    EXPECT_EQ(most_singular_values(Mat3(0.0)), Vec3(0.0));
    EXPECT_FALSE(flat_map(Mat3(0.0)));
    EXPECT_TRUE(is_singular({Mat3(0.0), {}}));
}

} // namespace
} // namespace graftal
