#include "compiler/analysis/volume.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "compiler/graph/verify.h"
#include "tests/unit/analysis/bounds_checks.h"
#include "tests/unit/analysis/systems.h"
#include "tests/unit/unfolded/random_solids.h"

namespace graftal {
namespace {

using namespace test;
using std::numbers::pi;

VolumeRange volume(const Graph& graph, std::optional<unsigned> steps = {}) {
    const std::optional<VolumeRange> range =
        volume_range(graph, strong_components(graph), bounds(graph), steps);
    EXPECT_TRUE(range);
    return range.value_or(VolumeRange{-1, -1});
}

void expect_exact(const VolumeRange& range, double volume) {
    EXPECT_NEAR(range.least, volume, 1e-12 * volume);
    EXPECT_NEAR(range.most, volume, 1e-12 * volume);
}

/// An object that combines primitives.
Graph combination(Combination how, const std::vector<std::pair<Primitive, Affine>>& parts) {
    Graph graph = empty_graph();
    graph.objects[graph.root].combination = how;
    for (const auto& [primitive, map] : parts)
        place(graph, graph.root, graph.primitive(primitive), map);
    return graph;
}

const Primitive ball = PrimitiveKind::sphere, cube = PrimitiveKind::cube;

TEST(Volume, OfPartsThatLieApartIsTheirSum) {
    expect_exact(volume(combination(Combination::unite,
                                    {{ball, {}},
                                     {cube, Affine::translate({2, 0, 0})},
                                     {ball, Affine::translate({0, 3, 0}) * Affine::scale({1, 2, 0.5})}})),
                 4 * pi / 3 + 8 + 4 * pi / 3);
}

TEST(Volume, OfPartsThatOverlapLiesBetweenTheLargestAndTheSum) {
    const VolumeRange range =
        volume(combination(Combination::unite, {{ball, {}}, {cube, Affine::translate({1, 0, 0})}}));
    EXPECT_EQ(range.least, 8);
    EXPECT_LE(range.most, 8 + 4 * pi / 3);
    EXPECT_GE(range.most, 8 + 2 * pi / 3); // half the ball lies in the cube
}

TEST(Volume, OfADifferenceIsExactWhereItsHolesLieWithin) {
    const Affine left = Affine::translate({-0.5, 0, 0}) * Affine::scale(Vec3(0.4));
    const Affine right = Affine::translate({0.5, 0, 0}) * Affine::scale(Vec3(0.4));
    const Affine away = Affine::translate({3, 0, 0});
    expect_exact(
        volume(combination(Combination::subtract, {{cube, {}}, {ball, left}, {ball, right}, {cube, away}})),
        8 - 2 * 0.064 * 4 * pi / 3);
    const VolumeRange crossing =
        volume(combination(Combination::subtract, {{cube, {}}, {ball, Affine::translate({1, 0, 0})}}));
    EXPECT_NEAR(crossing.least, 8 - 4 * pi / 3, 1e-12);
    EXPECT_EQ(crossing.most, 8);
}

TEST(Volume, OfAnIntersectionIsThatOfAPartThatTheOthersHold) {
    expect_exact(volume(combination(Combination::intersect, {{cube, {}}, {ball, Affine::scale(Vec3(0.5))}})),
                 pi / 6);
    EXPECT_LE(
        volume(combination(Combination::intersect, {{cube, {}}, {cube, Affine::translate({1.5, 0, 0})}}))
            .most,
        2 + 1e-9);
}

TEST(Volume, OfAnIntersectionOfVeryManyPartsIsOnlyBounded) {
    const auto nested = [](int count) {
        std::vector<std::pair<Primitive, Affine>> cubes;
        for (int i = 0; i < count; ++i)
            cubes.push_back({cube, Affine::scale(Vec3(2.0 - static_cast<double>(i) / count))});
        return volume(combination(Combination::intersect, cubes));
    };
    const double smallest = 8 * 1.001 * 1.001 * 1.001;
    expect_exact(nested(1000), smallest);
    // Each would be held against each.
    const VolumeRange many = nested(2000);
    EXPECT_EQ(many.least, 0);
    EXPECT_LE(many.most, smallest);
}

TEST(Volume, OfLimitsWithoutVolumeIsZero) {
    for (const auto& maps : {menger_maps(), sierpinski_tetrahedron(), sierpinski_triangle()})
        expect_exact(volume(ifs(maps)), 0);
}

TEST(Volume, OfLevelsIsThatOfTheirTerminals) {
    Graph graph = ifs(menger_maps());
    graph.objects[0].terminal = instance(graph.primitive(cube), {});
    for (const unsigned steps : {0u, 1u, 2u, 7u, 40u})
        expect_exact(volume(graph, steps), 8 * std::pow(20.0 / 27, steps));
}

/// The limit set touches the faces of the terminal's cube in their middles, and its ball cuts the corners
/// off.
TEST(Volume, OfTerminalsThatReachOutOfTheBallOfTheLimit) {
    const auto pair_of = [](const Primitive& terminal, double apart) {
        Graph graph = empty_graph();
        const ObjectId self = graph.add(named("self"));
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {-0.5, 0.5}) {
                Vec3 to(0.0);
                to[axis] = sign;
                place(graph, self, self, Affine::translate(to) * Affine::scale(Vec3(0.5)));
            }
        graph.objects[self].terminal = instance(graph.primitive(terminal), {});
        place(graph, graph.root, self, {});
        place(graph, graph.root, self, Affine::translate(Vec3(apart)));
        graph.objects[graph.root].terminal = instance(graph.primitive(ball), Affine::scale(Vec3(0.5)));
        return volume(graph, 1);
    };
    const VolumeRange cubes = pair_of(cube, 1.2); // which have a cube of 0.8 in common
    EXPECT_LE(cubes.least, 16 - 0.512);
    EXPECT_GE(cubes.most, 16 - 0.512);
    expect_exact(pair_of(cube, 2), 16);
    expect_exact(pair_of(ball, 1.2), 2 * 4 * pi / 3);
}

/// A ball, and copies of all of it aside: a geometric series.
TEST(Volume, OfALimitCountsWhatEachLevelAdds) {
    Graph graph = empty_graph();
    const ObjectId self = graph.add(named("self"));
    place(graph, self, graph.primitive(ball), {});
    place(graph, self, self, Affine::translate({1.5, 0, 0}) * Affine::scale(Vec3(1.0 / 3)));
    place(graph, graph.root, self, Affine::scale({2, 1, 1}));
    expect_exact(volume(graph), 2 * 4 * pi / 3 / (1 - 1.0 / 27));
    expect_exact(volume(graph, 2), 2 * 4 * pi / 3 * (1 + 1.0 / 27));
}

TEST(Volume, OfAPlaneIsNotKnown) {
    Graph graph = empty_graph();
    place(graph, graph.root, graph.primitive(PrimitiveKind::plane), {});
    place(graph, graph.root, graph.primitive(ball), {});
    EXPECT_FALSE(volume_range(graph, strong_components(graph), bounds(graph), {}));
}

/// Points that lie in random solids, counted.
TEST(Volume, HoldsWhatSamplingFinds) {
    constexpr unsigned levels = 3;
    constexpr int samples = 4000;
    int exact = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        RandomSolids random(seed);
        const Graph graph = random.graph();
        const Membership membership(graph);
        const VolumeRange range = volume(graph, levels);
        Box box = root_bounds(graph).box;
        const Vec3 margin = 0.5 * box.size(); // of few levels, what is drawn may be larger than the limit
        box = {box.min - margin, box.max + margin};
        int inside = 0;
        for (int i = 0; i < samples; ++i)
            inside += membership(box.centre() + 0.5 * random.vector() * box.size(), levels);
        const double whole = box.size().x * box.size().y * box.size().z, share = inside / double{samples};
        const double error = 4.5 * whole * std::sqrt(std::max(share * (1 - share), 1.0 / samples) / samples);
        EXPECT_LE(range.least, whole * share + error);
        EXPECT_GE(range.most, whole * share - error);
        exact += range.most - range.least <= 1e-9 * range.most;
    }
    EXPECT_GE(exact, 1);
}

} // namespace
} // namespace graftal
