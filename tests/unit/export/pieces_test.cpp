// The small pieces of exporting.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/export/formats/pbr.h"
#include "runtime/export/formats/plotter.h"
#include "runtime/export/formats/rigid_parts.h"

namespace graftal {
namespace {

Affine random_map(std::mt19937& random) {
    std::uniform_real_distribution<double> number(-2, 2);
    Affine map;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            map.linear[i][j] = number(random);
        map.translation[i] = number(random);
    }
    return map;
}

Affine map_of(const MoveTurnScale& at) {
    return Affine::translate(at.move) * Affine{glm::mat3_cast(at.turn), Vec3(0.0)} * Affine::scale(at.scale);
}

double apart(const Affine& a, const Affine& b) {
    double most = largest_entry(a.translation - b.translation);
    for (int i = 0; i < 3; ++i)
        most = std::max(most, largest_entry(a.linear[i] - b.linear[i]));
    return most;
}

TEST(RigidParts, TwoMovesAreAnyMap) {
    std::mt19937 random(7);
    for (int i = 0; i < 2000; ++i) {
        Affine map = random_map(random);
        if (i % 5 == 1) map.linear[1] = Vec3(0.0);                      // flat
        if (i % 5 == 2) map.linear[2] = 2.0 * map.linear[0];            // flat another way
        if (i % 25 == 3) map.linear[1] = map.linear[2] = map.linear[0]; // a line
        if (i % 25 == 4) map.linear = Mat3(0.0);
        if (i % 25 == 5) map.linear *= 1e-80;
        const auto [outer, inner] = two_moves(map);
        const double size = std::max(largest_entry(map.linear), 1e-300);
        const Affine again = map_of(outer) * map_of(inner);
        EXPECT_LT(apart({map.linear / size, map.translation}, {again.linear / size, again.translation}), 1e-9)
            << i;
        EXPECT_EQ(inner.scale, Vec3(1.0));
    }
}

TEST(RigidParts, AMoveIsWhatKeepsRightAngles) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> number(-2, 2);
    for (int i = 0; i < 2000; ++i) {
        const Affine turned = Affine::rotate(Vec3(number(random), number(random), 1), 90 * number(random));
        Affine map = Affine::translate(Vec3(number(random), 0, 1)) * turned *
                     Affine::scale(Vec3(number(random), number(random), number(random)));
        if (i % 7 == 0) map.linear[1] = Vec3(0.0);
        const auto one = move_turn_scale(map);
        ASSERT_TRUE(one);
        EXPECT_LT(apart(map, map_of(*one)), 1e-9) << i;
        const Affine sheared = turned * Affine::scale(Vec3(1, 2, 3)) * Affine::rotate(Vec3(1, 1, 1), 40);
        EXPECT_FALSE(move_turn_scale(sheared));
    }
}

TEST(PlaneView, PicturesOfPartsGoTogether) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> number(-2, 2);
    for (int i = 0; i < 500; ++i) {
        const SeenFrame world(Vec3(number(random), number(random), number(random) + 3));
        const Affine a = random_map(random), b = random_map(random);
        if (is_singular(a, 1e-3) || is_singular(b, 1e-3)) continue;
        const SeenFrame in_a = world.of_part(a), in_b = in_a.of_part(b);
        const Affine2 whole = world.picture_of(in_a, a) * in_a.picture_of(in_b, b);
        const Vec3 point(number(random), number(random), number(random));
        const Point2 direct = world((a * b)(point)), nested = whole(in_b(point));
        for (std::size_t axis = 0; axis < 2; ++axis)
            EXPECT_NEAR(direct[axis], nested[axis], 1e-6) << i;
    }
}

TEST(PlaneView, AnOutlineIsConvex) {
    const std::vector<Point2> outline =
        convex_outline({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1}, {0, 0}});
    EXPECT_THAT(outline,
                testing::UnorderedElementsAre(Point2{0, 0}, Point2{2, 0}, Point2{2, 2}, Point2{0, 2}));
    EXPECT_TRUE(convex_outline({}).empty());
    EXPECT_EQ(convex_outline({{1, 1}, {1, 1}}).size(), 1u);
    EXPECT_EQ(convex_outline({{0, 0}, {1, 1}, {2, 2}}).size(), 2u);
}

TEST(Plotter, JoinsStrokesAndDropsThoseDrawn) {
    const std::vector<PenStroke> path = pen_path(
        {{{0, 0}, {1, 0}}, {{5, 5}, {6, 5}}, {{2, 0}, {1, 0}}, {{1, 0}, {0, 0}}, {{2, 0}, {2, 1}}}, 1e-6);
    ASSERT_EQ(path.size(), 2u);
    EXPECT_EQ(path[0], (PenStroke{{0, 0}, {1, 0}, {2, 0}, {2, 1}}));
    EXPECT_EQ(path[1].size(), 2u);
}

TEST(Plotter, LiftsThePenForShorterWays) {
    std::mt19937 random(10);
    std::uniform_real_distribution<double> number(0, 100);
    std::vector<PenStroke> strokes;
    double length = 0;
    for (int i = 0; i < 3000; ++i) {
        const Point2 from{number(random), number(random)};
        strokes.push_back({from, {from[0] + 1, from[1]}});
        length += 1;
    }
    const std::vector<PenStroke> path = pen_path(strokes, 1e-6);
    double drawn = 0;
    for (const PenStroke& stroke : path)
        for (std::size_t i = 1; i < stroke.size(); ++i)
            drawn += std::hypot(stroke[i][0] - stroke[i - 1][0], stroke[i][1] - stroke[i - 1][1]);
    EXPECT_NEAR(drawn, length, 1e-6);
    EXPECT_LT(lifted_length(path), 0.05 * lifted_length(strokes));
    EXPECT_TRUE(pen_path({}, 1).empty());
}

/// The order by looking at every end that is left, each time.
std::vector<PenStroke> slow_path(std::vector<PenStroke> strokes, Point2 pen) {
    std::vector<PenStroke> path;
    while (!strokes.empty()) {
        std::size_t best = 0;
        bool last = false;
        double least = HUGE_VAL;
        for (std::size_t i = 0; i < strokes.size(); ++i)
            for (const bool at_last : {false, true}) {
                const Point2& end = at_last ? strokes[i].back() : strokes[i].front();
                const double away = std::hypot(pen[0] - end[0], pen[1] - end[1]);
                if (away >= least) continue;
                least = away;
                best = i;
                last = at_last;
            }
        PenStroke stroke = strokes[best];
        strokes.erase(strokes.begin() + static_cast<std::ptrdiff_t>(best));
        if (last) std::ranges::reverse(stroke);
        pen = stroke.back();
        path.push_back(std::move(stroke));
    }
    return path;
}

TEST(Plotter, GoesToTheNearestEndHoweverTheyAreSpread) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(0, 1);
    for (const double spread : {1.0, 30.0}) { // evenly, and most of them in a corner
        std::vector<PenStroke> strokes;
        for (int i = 0; i < 300; ++i) {
            const Point2 from{std::pow(number(random), spread), std::pow(number(random), spread)};
            strokes.push_back({from, {from[0] + number(random) / 10, from[1] + number(random) / 10}});
        }
        strokes[7].front() = {0, 0}; // where the pen begins
        EXPECT_EQ(pen_path(strokes, 1e-100), slow_path(strokes, {0, 0})) << spread;
    }
}

TEST(Plotter, DrawsRaysThatMeetInOnePoint) {
    constexpr int rays = 20'000; // each as near as all others, in the middle
    std::vector<PenStroke> strokes;
    for (int i = 0; i < rays; ++i) {
        const double angle = 2 * std::numbers::pi * i / rays;
        strokes.push_back({{0, 0}, {std::cos(angle), std::sin(angle)}});
    }
    const std::vector<PenStroke> path = pen_path(strokes, 1e-9);
    ASSERT_EQ(path.size(), rays / 2); // in on one, out on another
    EXPECT_LT(lifted_length(path), 2 * std::numbers::pi);
}

TEST(Plotter, HoldsPagesOfAnySize) {
    for (const double size : {1e-3, 1.0, 1e18, 1e40}) {
        const std::vector<PenStroke> path =
            pen_path({{{0, 0}, {size, 0}}, {{0, 0}, {2 * size, 0}}, {{0, 0}, {size, 0}}}, 1e-6);
        ASSERT_EQ(path.size(), 2u) << size;
        EXPECT_EQ(path[0], (PenStroke{{0, 0}, {size, 0}}));
        EXPECT_EQ(path[1], (PenStroke{{0, 0}, {2 * size, 0}}));
    }
}

TEST(Pbr, FollowsHighlightsAndMirrors) {
    Material dull, glossy, mirror;
    dull.specular = 0;
    glossy.specular = 0.8;
    glossy.roughness = 0.001;
    mirror.reflection = 0.9;
    mirror.metallic = 1;
    EXPECT_EQ(pbr_of(dull).roughness, 1);
    EXPECT_LT(pbr_of(glossy).roughness, 0.4);
    EXPECT_EQ(pbr_of(mirror).roughness, 0);
    EXPECT_EQ(pbr_of(mirror).metallic, 1);
}

} // namespace
} // namespace graftal
