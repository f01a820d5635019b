#pragma once

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/smallest_ball.h"
#include "tests/unit/analysis/sampling.h"

// What the tests of bounds ask of them.

namespace graftal::test {

inline std::vector<ObjectBounds> bounds(const Graph& graph) {
    const Components components = strong_components(graph);
    return bound_objects(graph, components, decide_contraction(graph, components));
}

inline ObjectBounds root_bounds(const Graph& graph) {
    return bounds(graph)[graph.root];
}

/// Near, and never inside.
inline void expect_box(const Box& box, Vec3 min, Vec3 max, double tolerance = 1e-9) {
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(box.min[i], min[i], tolerance) << "axis " << i;
        EXPECT_NEAR(box.max[i], max[i], tolerance) << "axis " << i;
        EXPECT_LE(box.min[i], min[i] + 1e-15) << "axis " << i;
        EXPECT_GE(box.max[i], max[i] - 1e-15) << "axis " << i;
    }
}

inline bool inside(const ObjectBounds& bounds, Vec3 point) {
    for (int i = 0; i < 3; ++i)
        if (!(point[i] >= bounds.box.min[i] && point[i] <= bounds.box.max[i])) return false;
    return glm::length(point - bounds.ball.centre) <= bounds.ball.radius * (1 + 1e-14);
}

inline double smallest_radius(const std::vector<Vec3>& points) {
    std::vector<Ball> balls;
    for (const Vec3 point : points)
        balls.push_back({point, 0});
    return smallest_ball(balls).radius;
}

/// Random points of every object lie inside; those of the root come near each face of the box and leave
/// little room in the ball.
inline void expect_outer_and_tight(const Graph& graph, double room_in_box, double room_in_ball) {
    const std::vector<ObjectBounds> found = bounds(graph);
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        if (graph.objects[id].primitive) continue;
        const std::vector<Vec3> points = random_points(graph, id, 5'000 / graph.objects.size() + 100, id + 1);
        for (const Vec3 point : points)
            ASSERT_TRUE(inside(found[id], point)) << graph.objects[id].name;
    }
    const std::vector<Vec3> points = random_points(graph, graph.root, 8'000, 99);
    Box box;
    for (const Vec3 point : points)
        box.include(point);
    const ObjectBounds& root = found[graph.root];
    const double allowed = room_in_box * glm::length(root.box.size());
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(root.box.min[i], box.min[i], allowed) << "axis " << i;
        EXPECT_NEAR(root.box.max[i], box.max[i], allowed) << "axis " << i;
    }
    EXPECT_LE(root.ball.radius, smallest_radius(points) * (1 + room_in_ball));
}

} // namespace graftal::test
