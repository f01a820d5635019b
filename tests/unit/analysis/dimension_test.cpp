#include <cmath>

#include <gtest/gtest.h>

#include "compiler/analysis/counts.h"
#include "tests/unit/analysis/systems.h"

namespace graftal {
namespace {

using namespace test;

std::optional<double> dimension(const Graph& graph) {
    return similarity_dimension(graph, strong_components(graph));
}

TEST(Dimension, OfKnownSets) {
    EXPECT_NEAR(dimension(pound_sign(2)).value(), std::log2(3), 1e-10);
    EXPECT_NEAR(dimension(pound_sign(3)).value(), std::log2(7), 1e-10);
    EXPECT_NEAR(dimension(menger_digraph()).value(), std::log(20) / std::log(3), 1e-10);
    EXPECT_NEAR(dimension(ifs(menger_maps())).value(), std::log(20) / std::log(3), 1e-10);
    EXPECT_NEAR(dimension(ifs(sierpinski_triangle())).value(), std::log2(3), 1e-10);
    EXPECT_NEAR(dimension(ifs(sierpinski_tetrahedron())).value(), 2, 1e-10);
    EXPECT_NEAR(dimension(ifs(twin_dragon())).value(), 2, 1e-10);
    EXPECT_NEAR(dimension(ifs(heighway_dragon())).value(), 2, 1e-10);
}

TEST(Dimension, OfTheGoldenMeanGraph) {
    const Affine half = scaled(0.5, Vec3(0.0));
    EXPECT_NEAR(dimension(digraph(2, {{0, 0, half}, {0, 1, half}, {1, 0, half}})).value(),
                std::log2((1 + std::sqrt(5)) / 2), 1e-10);
}

TEST(Dimension, SolvesMoransEquationForUnequalRatios) {
    const double s =
        dimension(ifs({scaled(.5, Vec3(0.0)), scaled(.25, Vec3(1.0)), scaled(.1, Vec3(2.0))})).value();
    EXPECT_NEAR(std::pow(.5, s) + std::pow(.25, s) + std::pow(.1, s), 1, 1e-10);
}

TEST(Dimension, EdgesMayExpandWithinContractingCycles) {
    // Two ways round, each by 2 * 0.2 = 0.4 over two edges.
    const Graph graph = digraph(
        2, {{0, 1, scaled(2, Vec3(0.0))}, {0, 1, scaled(2, Vec3(1.0))}, {1, 0, scaled(.2, Vec3(0.0))}});
    EXPECT_NEAR(dimension(graph).value(), std::log(2) / -std::log(.4), 1e-10);
}

TEST(Dimension, OfASinglePointIsZero) {
    EXPECT_EQ(dimension(ifs({scaled(.5, Vec3(0.0))})), 0);
    EXPECT_EQ(
        dimension(long_cycle(1000, [](std::size_t i) { return scaled(i % 2 == 0 ? .5 : 1.5, Vec3(0.0)); })),
        0);
}

TEST(Dimension, TheLargestReachableComponentCounts) {
    Graph graph = digraph(4, {{0, 1, Affine{}}, {0, 2, Affine{}}});
    for (int i = 0; i < 3; ++i)
        graph.objects[1].instances.push_back(instance(1, scaled(.5, Vec3(0.0))));
    for (int i = 0; i < 5; ++i)
        graph.objects[2].instances.push_back(instance(2, scaled(.5, Vec3(0.0))));
    for (int i = 0; i < 7; ++i)
        graph.objects[3].instances.push_back(instance(3, scaled(.5, Vec3(0.0))));
    EXPECT_NEAR(dimension(graph).value(), std::log2(5), 1e-10);
    graph.root = 3;
    EXPECT_NEAR(dimension(graph).value(), std::log2(7), 1e-10);
}

TEST(Dimension, IsUndefinedForEndingGraphsAndForAffineMaps) {
    Graph ending;
    ending.root = ending.primitive(PrimitiveKind::sphere);
    EXPECT_EQ(dimension(ending), std::nullopt);
    EXPECT_EQ(dimension(ifs(barnsley_fern())), std::nullopt);
    EXPECT_EQ(dimension(ifs({Affine::scale({.5, .5, .4})})), std::nullopt);
}

TEST(Dimension, IsUndefinedWhereACycleDoesNotContract) {
    EXPECT_EQ(dimension(ifs({Affine{}})), std::nullopt);
    EXPECT_EQ(dimension(ifs({Affine{}, scaled(.5, Vec3(1.0))})), std::nullopt);
    EXPECT_EQ(dimension(ifs({scaled(3, Vec3(0.0)), scaled(.5, Vec3(1.0))})), std::nullopt);
}

TEST(Dimension, RotatedAndMirroredMapsAreSimilarities) {
    std::vector<Affine> maps;
    for (int i = 0; i < 4; ++i)
        maps.push_back(Affine::rotate({1, i, 2}, 37.0 * i) * Affine::scale({.5, .5, i % 2 == 0 ? -.5 : .5}));
    EXPECT_NEAR(dimension(ifs(maps)).value(), 2, 1e-9);
}

TEST(Dimension, OfALargeComponentOfUnequalObjects) {
    // A ring of 500 objects with chords, each ratio its own: too large and too various to take together.
    std::vector<Edge> edges;
    for (ObjectId i = 0; i < 500; ++i) {
        edges.push_back({i, (i + 1) % 500, scaled(.5 + .0002 * i, Vec3(0.0))});
        edges.push_back({i, (i * 7 + 3) % 500, scaled(.4, Vec3(0.0))});
    }
    const double s = dimension(digraph(500, edges)).value();
    EXPECT_GT(s, std::log(2) / -std::log(.4));
    EXPECT_LT(s, std::log(2) / -std::log(.6));
}

TEST(Dimension, OfAVeryLargeComponentEndsSoon) {
    // A ring of 100,000 objects with one chord: grouping objects does not end soon, nor does the iteration.
    std::vector<Edge> edges;
    for (ObjectId i = 0; i < 100'000; ++i)
        edges.push_back({i, (i + 1) % 100'000, scaled(.9, Vec3(0.0))});
    edges.push_back({0, 50'000, scaled(.5, Vec3(0.0))});
    const std::optional<double> s = dimension(digraph(100'000, edges));
    EXPECT_LT(s.value_or(0), 1);
    EXPECT_EQ(count_leaves(digraph(100'000, edges), strong_components(digraph(100'000, edges)), 5), "2");
}

} // namespace
} // namespace graftal
