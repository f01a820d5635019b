#include "compiler/zoom/focus.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/detail/models.h"

namespace graftal {
namespace {

/// Two cubes, three units to either side of the origin, where nothing is.
Graph two_cubes() {
    Graph graph;
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    Object pair{"pair", {}, {}, {}, {}};
    pair.instances.push_back({cube, Affine::translate({-3, 0, 0}), {}, {}, {}});
    pair.instances.push_back({cube, Affine::translate({4, 0, 0}) * Affine::scale(Vec3(0.5)), {}, {}, {}});
    graph.root = graph.add(std::move(pair));
    return graph;
}

TEST(Focus, OfAModelThatEndsIsOnTheSurfaceTowardsTheEye) {
    const Graph graph = two_cubes();
    const auto bounds = test::bounds_of(graph);
    const Magnification zoom = *Magnification::parse("1e6");
    for (const Vec3 to_eye : {Vec3(1, 2, 3), Vec3(-1, 0.5, 2), Vec3(0.1, -5, 1)}) {
        const Focus near = focus_near_point(graph, bounds, {-0.5, 0, 0}, zoom, to_eye);
        ASSERT_EQ(near.path.steps.size(), 1u);
        EXPECT_EQ(near.points.front(), Vec3(-3, 0, 0) + glm::sign(to_eye));
        const Focus other = focus_near_point(graph, bounds, {3, 0, 0}, zoom, to_eye);
        EXPECT_EQ(other.points.front(), Vec3(4, 0, 0) + 0.5 * glm::sign(to_eye));
    }
}

TEST(Focus, OfAModelThatGoesOnDoesNotEndInAPrimitive) {
    Graph graph = two_cubes();
    // The pair in itself, half as large, far from the cubes.
    graph.objects[graph.root].instances.push_back(
        {graph.root, Affine::translate({0, 2, 0}) * Affine::scale(Vec3(0.5)), {}, {}, {}});
    const auto bounds = test::bounds_of(graph);
    const Focus focus = focus_near_point(graph, bounds, {-3, 0, 0}, *Magnification::parse("1e6"), {0, 0, 1});
    ASSERT_FALSE(focus.path.steps.empty());
    for (const GraphStep& step : focus.path.steps)
        EXPECT_EQ(graph.objects[step.object].instances[step.instance].master, graph.root);
}

} // namespace
} // namespace graftal
