// Solid patterns: their slopes against differences, their range, and what fades with the distance.

#include "runtime/trace/shade/patterns.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/primitives/part_size.h"
#include "compiler/support/formula_words.h"

namespace graftal {
namespace {

constexpr PatternKind kinds[] = {PatternKind::noise, PatternKind::ridges, PatternKind::cells,
                                 PatternKind::bands, PatternKind::rings};

SolidPattern pattern_of(PatternKind kind, double warp = 0) {
    SolidPattern pattern;
    pattern.layers = {{.kind = kind, .scale = 0.7, .stretch = {1, 2, 0.5}, .octaves = 3, .warp = warp}};
    return pattern;
}

Vec3 place_in(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-3, 3);
    return {unit(random), unit(random), unit(random)};
}

TEST(Patterns, SlopesAreThoseOfDifferences) {
    std::mt19937_64 random(1);
    for (const PatternKind kind : kinds)
        for (const double warp : {0.0, 0.8}) {
            SCOPED_TRACE(static_cast<int>(kind) + warp);
            SolidPattern pattern = pattern_of(kind, warp);
            pattern.layers.push_back({.kind = PatternKind::noise, .scale = 0.2, .octaves = 2, .share = 0.3});
            int far_off = 0;
            constexpr int places = 200;
            for (int i = 0; i < places; ++i) {
                const Vec3 at = place_in(random);
                const Vec3 relief = pattern_at(pattern, 1.3, 0, at).relief;
                // The relief is that of layers by their depths.
                const auto height = [&](Vec3 place) {
                    double sum = 0;
                    for (const PatternLayer& layer : pattern.layers) {
                        SolidPattern alone;
                        alone.layers = {layer};
                        alone.layers.front().share = 1;
                        const double own =
                            relief_depth * wavelength_of(layer, 1.3) * pattern_at(alone, 1.3, 0, place).value;
                        sum = (1 - layer.share) * sum + layer.share * own;
                    }
                    return sum;
                };
                constexpr double step = 1e-6;
                Vec3 measured;
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3 aside(0.0);
                    aside[axis] = step;
                    measured[axis] = (height(at + aside) - height(at - aside)) / (2 * step);
                }
                far_off += glm::length(relief - measured) > 1e-6 + 1e-5 * glm::length(measured);
            }
            // Folds have no slope, and a difference across one is none.
            EXPECT_LE(far_off, 2);
        }
}

TEST(Patterns, CosinesAreThoseOfTheLibrary) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> exponent(-6, 6);
    for (int i = 0; i < 20'000; ++i) {
        const double angle = (i % 2 ? 1 : -1) * std::pow(10, exponent(random));
        double cosine = 0, sine = 0;
        formulas::cosine_and_sine(angle, cosine, sine);
        ASSERT_NEAR(cosine, std::cos(angle), 2e-9) << angle;
        ASSERT_NEAR(sine, std::sin(angle), 2e-9) << angle;
    }
}

TEST(Patterns, ValuesLieAboutTheMiddle) {
    std::mt19937_64 random(2);
    for (const PatternKind kind : kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        const SolidPattern pattern = pattern_of(kind, 0.5);
        double sum = 0, squares = 0;
        constexpr int places = 4000;
        for (int i = 0; i < places; ++i) {
            const double value = pattern_at(pattern, 1, 0, place_in(random)).value;
            ASSERT_GT(value, 0);
            ASSERT_LT(value, 1);
            sum += value;
            squares += (value - 0.5) * (value - 0.5);
        }
        EXPECT_NEAR(sum / places, 0.5, 0.08);
        EXPECT_GT(std::sqrt(squares / places), 0.2) << "it shows";
    }
}

TEST(Patterns, WhatIsFinerThanASampleFadesOut) {
    std::mt19937_64 random(3);
    const SolidPattern pattern = pattern_of(PatternKind::noise, 0.5);
    const auto variation = [&](double footprint) {
        double sum = 0;
        for (int i = 0; i < 500; ++i) {
            const PatternValue at = pattern_at(pattern, 1, footprint, place_in(random));
            sum += std::abs(at.value - 0.5) + glm::length(at.relief);
        }
        return sum;
    };
    EXPECT_NEAR(variation(1e-6) / variation(0), 1, 0.1);
    EXPECT_LT(variation(0.2), 0.9 * variation(0));
    EXPECT_EQ(variation(10), 0);
}

TEST(Patterns, SlopesThatFadeAreKeptAsTheirMeanSquare) {
    std::mt19937_64 random(6);
    for (const PatternKind kind : kinds)
        for (const double warp : {0.0, 0.8})
            for (const double footprint : {0.05, 0.15, 10.0}) {
                SCOPED_TRACE(testing::Message()
                             << static_cast<int>(kind) << " warp " << warp << " footprint " << footprint);
                SolidPattern pattern = pattern_of(kind, warp);
                pattern.layers.push_back({.kind = kind, .scale = 0.4, .octaves = 2, .share = 0.3});
                double whole = 0, seen = 0, faded = 0, before = 0;
                for (int i = 0; i < 20'000; ++i) {
                    const Vec3 at = place_in(random);
                    const PatternValue fine = pattern_at(pattern, 1, 0, at);
                    const PatternValue coarse = pattern_at(pattern, 1, footprint, at);
                    whole += glm::dot(fine.relief, fine.relief);
                    seen += glm::dot(coarse.relief, coarse.relief);
                    faded += 3 * coarse.faded;
                    before += fine.faded;
                }
                EXPECT_EQ(before, 0);
                EXPECT_NEAR((seen + faded) / whole, 1, 0.4);
            }
}

TEST(Patterns, PartsOfAboutOneSizeLookAlike) {
    std::mt19937_64 random(4);
    const SolidPattern pattern = pattern_of(PatternKind::noise);
    double near = 0, far = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 at = place_in(random);
        const double value = pattern_at(pattern, 1, 0, at).value;
        near += std::abs(value - pattern_at(pattern, 1.02, 0, at).value);
        far += std::abs(value - pattern_at(pattern, 8, 0, at).value);
    }
    EXPECT_LT(near, 0.1 * far);
}

TEST(Patterns, ASizeIsThatOfABranchsRadius) {
    const auto scaled = [](double x, double y, double z) {
        Mat3 map(0.0);
        map[0][0] = x, map[1][1] = y, map[2][2] = z;
        return map;
    };
    EXPECT_DOUBLE_EQ(part_size(PrimitiveKind::cylinder, scaled(0.1, 5, 0.1)), 0.1);
    EXPECT_DOUBLE_EQ(part_size(PrimitiveKind::cube, scaled(3, 0.01, 2)), 2);
    EXPECT_DOUBLE_EQ(part_size(PrimitiveKind::plane, scaled(3, 3, 3)), 1);
    EXPECT_DOUBLE_EQ(pattern_size(0.25), 0.25);
    EXPECT_DOUBLE_EQ(pattern_size(0.26), 0.25);
    EXPECT_DOUBLE_EQ(pattern_size(0.35), 0.25 * std::sqrt(2.0));
}

TEST(Patterns, AReliefFacesTheViewer) {
    const Vec3 normal(0, 0, 1), ray(0, 0.6, -0.8);
    EXPECT_EQ(bumped(normal, Vec3(0.0), 2, ray), normal);
    EXPECT_NEAR(bumped(normal, {0.1, 0, 0}, 1, ray).x, -0.1 / std::sqrt(1.01), 1e-12);
    for (const double bump : {-50.0, 3.0, 1000.0})
        EXPECT_GT(-glm::dot(bumped(normal, {0.3, -0.4, 0.5}, bump, ray), ray), 0);
}

} // namespace
} // namespace graftal
