#include "compiler/analysis/bounding.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/analysis/systems.h"

namespace graftal {
namespace {

using namespace test;

std::vector<ObjectBounds> bounds(const Graph& graph) {
    const Components components = strong_components(graph);
    return bound_objects(graph, components, decide_contraction(graph, components));
}

ObjectBounds root_bounds(const Graph& graph) {
    return bounds(graph)[graph.root];
}

void expect_box(const Box& box, Vec3 min, Vec3 max, double tolerance) {
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(box.min[i], min[i], tolerance) << "axis " << i;
        EXPECT_NEAR(box.max[i], max[i], tolerance) << "axis " << i;
        EXPECT_LE(box.min[i], min[i] + 1e-15) << "axis " << i;
        EXPECT_GE(box.max[i], max[i] - 1e-15) << "axis " << i;
    }
}

TEST(Bounding, BoxesOfKnownLimitSets) {
    const double s = std::numbers::sqrt3 / 2;
    expect_box(root_bounds(pound_sign(3)).box, Vec3(-1.0), Vec3(1.0), 1e-9);
    expect_box(root_bounds(pound_sign(2)).box, {-1, -1, 0}, {1, 1, 0}, 1e-9);
    expect_box(root_bounds(ifs(menger_maps())).box, Vec3(-1.0), Vec3(1.0), 1e-9);
    expect_box(root_bounds(menger_digraph()).box, {-1, -1, -1}, {-1 + 2. / 3, -1 + 2. / 3, -1 + 2. / 3},
               1e-9);
    expect_box(root_bounds(ifs(sierpinski_triangle())).box, {-s, -.5, 0}, {s, 1, 0}, 1e-9);
    expect_box(root_bounds(ifs(sierpinski_tetrahedron())).box, Vec3(-1.0), Vec3(1.0), 1e-9);
    expect_box(root_bounds(ifs(twin_dragon())).box, {-2. / 3, -1. / 3, 0}, {5. / 3, 4. / 3, 0}, 1e-9);
    expect_box(root_bounds(ifs(heighway_dragon())).box, {-1. / 3, -1. / 3, 0}, {7. / 6, 2. / 3, 0}, 1e-9);
    expect_box(root_bounds(ifs(levy_curve())).box, {-.5, -.25, 0}, {1.5, 1, 0}, 1e-9);
}

} // namespace
} // namespace graftal
