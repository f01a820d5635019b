#include "runtime/inverse/plane_map.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "runtime/inverse/attractor.h"
#include "runtime/inverse/map_steps.h"
#include "runtime/inverse/refine.h"

namespace graftal {
namespace {

void expect_near(Vec2 a, Vec2 b) {
    EXPECT_NEAR(a.x, b.x, 1e-9);
    EXPECT_NEAR(a.y, b.y, 1e-9);
}

TEST(PlaneMap, ItsStretchMakesItAgain) {
    Draws draws(CounterRandom(1), 0);
    for (int i = 0; i < 100; ++i) {
        PlaneMap map;
        for (double* entry : {&map.a, &map.b, &map.c, &map.d, &map.e, &map.f})
            *entry = draws.between(-0.5, 0.5);
        const PlaneStretch stretch = stretch_of(map);
        EXPECT_NEAR(stretch.largest * stretch.least, map.determinant(), 1e-12);
        const Vec2 p(draws.unit(), draws.unit()), q(draws.unit(), draws.unit());
        expect_near(map_of(stretch, p, map(p))(q), map(q));
        expect_near(map(fixed_point(map)), fixed_point(map));
        expect_near(bounded_inverse(map, p, 0)(map(q)), q);
    }
}

TEST(PlaneMap, AFlatMapHasABoundedInverse) {
    const PlaneMap stem{0, 0, 0, 0.16, 0, 0};
    EXPECT_NEAR(stretch_of(bounded_inverse(stem, {0, 0}, 0.01)).largest, 100, 1e-9);
}

TEST(PlaneMap, ALongMapIsCutAboutTheCentre) {
    const double step[6] = {3, 0, 2, 0, 0, 1};
    const Vec2 centre(5, 7);
    const PlaneMap map = moved({0.5, 0.1, -0.1, 0.5, 0, 0}, step, centre, 0.9);
    EXPECT_NEAR(stretch_of(map).largest, 0.9, 1e-12);
    expect_near(map(centre), Vec2(0.5 * 5 + 0.1 * 7 + 2, -0.1 * 5 + 0.5 * 7 + 1));
}

TEST(PlaneMap, TheNearestSimilarityKeepsAngles) {
    for (const double d : {0.4, -0.4}) {
        const PlaneMap map = nearest_similarity({0.5, -0.2, 0.1, d, 3, 4}, {1, 2});
        const PlaneStretch stretch = stretch_of(map);
        EXPECT_NEAR(stretch.largest, std::abs(stretch.least), 1e-12);
        EXPECT_EQ(std::signbit(stretch.least), d < 0);
    }
}

/// A filled square, and the four maps that make it.
struct Square {
    CellSet set{64, 64};
    PlaneMaps maps;

    Square() {
        set.cells.assign(set.cells.size(), true);
        const double room = Target(set).room();
        for (const Vec2 corner : {Vec2(0, 0), Vec2(64, 0), Vec2(0, 64), Vec2(64, 64)})
            maps.push_back(map_of({0.5, 0.5, 0, 0}, corner + room, corner + room));
    }
};

TEST(Attractor, FillsTheSquareThatItIs) {
    const Square square;
    const Target target(square.set);
    AttractorPainter painter(target);
    painter.draw(square.maps);
    const SetAgreement agreement = painter.agreement_in_full();
    EXPECT_EQ(agreement.tolerant, 1);
    EXPECT_GT(agreement.strict, 0.95);
    EXPECT_LT(agreement.chamfer, 0.05);
    // Three of the maps make a gasket: a part of the cells, and none outside.
    const PlaneMaps three(square.maps.begin(), square.maps.end() - 1);
    painter.draw(three);
    EXPECT_LT(painter.agreement().strict, 0.4);
    painter.draw(square.maps);
    EXPECT_EQ(painter.agreement().tolerant, 1) << "nothing is left of an earlier drawing";
}

TEST(MapSteps, KeepTheRulesAndTheMostMaps) {
    const Square square;
    const Target target(square.set);
    Draws draws(CounterRandom(6), 0);
    for (const bool similar : {false, true}) {
        const MapSteps steps(target, {0.9, similar}, 5);
        PlaneMaps maps(square.maps.begin(), square.maps.begin() + 1);
        std::size_t most = 0, fewest = 5;
        for (int i = 0; i < 3000; ++i) {
            steps.step(maps, std::span(target.points()).first(i % 2 ? 9 : 0), draws);
            ASSERT_FALSE(maps.empty());
            ASSERT_LE(largest_stretch(maps), 0.9 + 1e-9);
            for (const PlaneMap& map : maps)
                ASSERT_TRUE(!similar || std::abs(std::abs(map.a) - std::abs(map.d)) < 1e-9);
            most = std::max(most, maps.size());
            if (i > 1000) fewest = std::min(fewest, maps.size());
        }
        EXPECT_EQ(most, 5);
        EXPECT_EQ(fewest, 2);
    }
}

TEST(Refine, MovesMapsBackToTheCollage) {
    const Square square;
    const Target target(square.set);
    Draws draws(CounterRandom(5), 0);
    for (const int levels : {1, 2, 4}) {
        PlaneMaps maps = square.maps;
        for (PlaneMap& map : maps) {
            map.a += draws.between(-0.02, 0.02);
            map.d += draws.between(-0.02, 0.02);
            map.e += draws.between(-1, 1);
        }
        AttractorPainter painter(target);
        painter.draw(maps);
        const double before = painter.agreement().tolerant;
        refine(target, {target.drawn(200, draws), target.drawn(600, draws)}, {levels, 15, 4.0}, MapRules(),
               draws, maps);
        painter.draw(maps);
        EXPECT_GT(painter.agreement().tolerant, std::max(before, 0.99)) << levels;
    }
}

} // namespace
} // namespace graftal
