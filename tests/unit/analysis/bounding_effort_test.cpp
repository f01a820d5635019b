#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "tests/unit/analysis/bounds_checks.h"
#include "tests/unit/analysis/systems.h"

// What the search for box faces looks at, in pieces, where many maps of unequal scales meet.

namespace graftal {
namespace {

using namespace test;

double between(double low, double high, std::mt19937& random) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// Each map after every other, as a front-end with a control digraph makes it.
Graph each_after_all(const std::vector<Affine>& maps) {
    std::vector<Edge> edges;
    for (ObjectId i = 0; i < maps.size(); ++i)
        for (ObjectId j = 0; j < maps.size(); ++j)
            edges.push_back({i, j, maps[i]});
    return digraph(maps.size(), edges);
}

std::uint64_t pieces_looked_at(const Graph& graph) {
    const Components components = strong_components(graph);
    std::uint64_t pieces = 0;
    bound_objects(graph, components, decide_contraction(graph, components), no_control(), &pieces);
    return pieces;
}

TEST(BoundingEffort, AcrossAPlaneUnequalScalesNeedNoSearch) {
    std::mt19937 random(7);
    std::vector<Affine> maps;
    for (int i = 0; i < 22; ++i)
        maps.push_back(Affine::translate({between(-1, 1, random), between(-1, 1, random), 0}) *
                       Affine::rotate({0, 0, 1}, between(-180, 180, random)) *
                       Affine::scale(Vec3(between(.2, .5, random))));
    const Graph graph = each_after_all(maps);
    EXPECT_LT(pieces_looked_at(graph), 300'000u); // the search across the plane alone took 8 million
    EXPECT_NEAR(root_bounds(graph).box.size().z, 0, 1e-9);
    expect_outer_and_tight(graph, .03, .05);
}

TEST(BoundingEffort, MapsThatShearAndHardlyContractAreSearchedInPasses) {
    std::mt19937 random(11);
    std::vector<Affine> maps;
    for (int i = 0; i < 14; ++i) {
        const auto entry = [&] { return between(-.55, .55, random); };
        const double a = entry(), b = entry(), c = entry(), d = entry();
        maps.push_back(plane_map(a, b, c, d, between(-1, 1, random), between(-1, 1, random)));
    }
    maps.push_back(plane_map(.68, .03, -.06, .38, -.42, -.39));
    maps.push_back(plane_map(.01, .25, .59, -.79, -.83, -.98));
    maps.push_back(plane_map(-.19, -.40, .94, .08, .28, -.45));
    const Graph graph = each_after_all(maps);
    EXPECT_LT(pieces_looked_at(graph), 1'000'000u); // 4 million before, for boxes of twice the size
    expect_outer_and_tight(graph, .2, 1);           // random points hardly get to the ends
}

} // namespace
} // namespace graftal
