// Random points of runs: each part gets as many as its surface is large.

#include <cmath>
#include <memory>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/graph/run.h"
#include "tests/unit/chaos/games.h"

namespace graftal {
namespace {

using std::numbers::pi;

/// A segment with its ball, far from it a sphere, and a cone; and a sphere beside the run.
Graph model() {
    Graph graph;
    Material red;
    red.name = "red";
    red.rgb = {1, 0, 0};
    graph.materials.push_back(red);
    auto run = std::make_shared<Run>();
    RunItem item;
    item.axis = {0, 3, 0};
    item.radius = 0.5;
    item.shape = PrimitiveKind::cylinder;
    item.ball = true;
    run->add(item);
    item.base = {100, 0, 0};
    item.axis = {0, 2, 0};
    item.radius = 2;
    item.shape = PrimitiveKind::sphere;
    item.ball = false;
    item.colour = 1;
    run->add(item);
    item.base = {200, 0, 0};
    item.axis = {1, 0, 0};
    item.radius = 1;
    item.shape = PrimitiveKind::cone;
    run->add(item);
    Object object;
    object.name = "parts";
    object.packed.run = run;
    object.packed.materials = {std::nullopt, MaterialId{0}};
    Object root;
    root.name = "root";
    root.instances.push_back({graph.add(std::move(object)), Affine::scale(Vec3(2.0)), {}, {}, {}});
    root.instances.push_back(
        {graph.primitive(PrimitiveKind::sphere), Affine::translate({600, 0, 0}), {}, {}, {}});
    graph.root = graph.add(std::move(root));
    return graph;
}

TEST(RunPoints, AreSpreadByArea) {
    const Graph graph = model();
    const Components components = strong_components(graph);
    const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
    const auto game = ChaosGame::of(graph, components, bounds, 0);
    ASSERT_TRUE(game);
    std::vector<double> counts(5, 0.0);
    for (const ChaosPoint& point : testing::points_of(*game, 100'000, 3)) {
        const Vec3 p = point.place;
        const int part = p.x < 100 ? 0 : p.x < 300 ? 1 : p.x < 500 ? 2 : 3;
        const bool ball = part == 0 && glm::distance(p, Vec3(0, 6, 0)) < 1 + 1e-9 &&
                          std::abs(glm::length(Vec3(p.x, 0, p.z)) - 1) > 1e-9;
        ++counts[ball ? 4u : static_cast<std::size_t>(part)];
        if (part == 1) {
            EXPECT_NEAR(glm::distance(p, Vec3(200, 0, 0)), 4, 1e-9);
        }
        EXPECT_EQ(point.rgb[1] == 0, part == 1 || part == 2); // red
    }
    // In the world all of the run is twice as large; the upper cap of the segment lies within its ball.
    const double ball = 4 * pi * 0.25, side = 2 * pi * 0.5 * 3, cap = pi * 0.25;
    std::vector<double> areas = {4 * (side + cap), 4 * 16 * pi, 4 * (pi + pi * std::sqrt(2.0)), 4 * pi,
                                 4 * (ball + cap)};
    double sum = 0;
    for (const double area : areas)
        sum += area;
    for (double& area : areas)
        area /= sum;
    testing::expect_by_chance(counts, areas);
}

} // namespace
} // namespace graftal
