#include "compiler/analysis/bounding.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/analysis/bounds_checks.h"
#include "tests/unit/analysis/sampling.h"
#include "tests/unit/analysis/systems.h"
#include "tests/unit/primitives/all_primitives.h"

namespace graftal {
namespace {

using namespace test;

TEST(Bounding, PrimitivesAreExact) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (const Primitive& kind : all_primitives()) {
        const ObjectBounds found = primitive_bounds(kind);
        EXPECT_EQ(found.unbounded, kind == PrimitiveKind::plane);
        if (kind == PrimitiveKind::plane) continue;
        Box box;
        std::vector<Vec3> points;
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 point = random_point_of(kind, random);
            points.push_back(point);
            box.include(point);
            for (int j = 0; j < 3; ++j) {
                ASSERT_GE(point[j], found.box.min[j] - 1e-12);
                ASSERT_LE(point[j], found.box.max[j] + 1e-12);
            }
            ASSERT_LE(glm::length(point - found.ball.centre), found.ball.radius + 1e-12);
        }
        EXPECT_LE(found.ball.radius, smallest_radius(points) * 1.03) << name_of(kind);
        EXPECT_LE(glm::length(found.box.size()), glm::length(box.size()) * 1.02) << name_of(kind);
        for (int i = 0; i < 20; ++i) {
            const Vec3 direction(normal(random), normal(random), normal(random));
            double farthest = -INFINITY;
            for (const Vec3 point : points)
                farthest = std::max(farthest, glm::dot(direction, point));
            const double support = primitive_support(kind, direction);
            EXPECT_GE(support, farthest - 1e-12);
            EXPECT_LE(support, farthest + 0.05 * glm::length(direction)) << name_of(kind);
        }
    }
}

/// The union of all images of primitives: exact bounds of ending objects by looking at every leaf.
void box_of_leaves(const Graph& graph, ObjectId id, const Affine& place, Box& box) {
    const Object& object = graph.objects[id];
    if (!object.primitive) {
        for (const Instance& instance : object.instances)
            box_of_leaves(graph, instance.master, place * instance.parent_from_child, box);
        return;
    }
    for (int i = 0; i < 3; ++i) {
        const Vec3 row(place.linear[0][i], place.linear[1][i], place.linear[2][i]);
        box.max[i] = std::max(box.max[i], place.translation[i] + primitive_support(*object.primitive, row));
        box.min[i] = std::min(box.min[i], place.translation[i] - primitive_support(*object.primitive, -row));
    }
}

TEST(Bounding, EndingObjectsAreExact) {
    std::mt19937 random(3);
    for (int round = 0; round < 40; ++round) {
        Graph graph;
        for (const Primitive& primitive : all_primitives())
            if (primitive != PrimitiveKind::plane) graph.primitive(primitive);
        for (int i = 0; i < 6; ++i) {
            Object object = named(numbered("o", static_cast<std::size_t>(i)));
            for (int j = 0; j < 3; ++j)
                object.instances.push_back(instance(static_cast<ObjectId>(random() % graph.objects.size()),
                                                    random_affine(random, .8)));
            graph.root = graph.add(std::move(object));
        }
        const std::vector<ObjectBounds> found = bounds(graph);
        for (ObjectId id = 0; id < graph.objects.size(); ++id) {
            Box box;
            box_of_leaves(graph, id, Affine{}, box);
            expect_box(found[id].box, box.min, box.max, 1e-10 * glm::length(box.size()));
        }
        expect_outer_and_tight(graph, 0.2, 0.2);
    }
}

TEST(Bounding, ATrunkBelongsToTheRecursionAndTheTerminalDoesNot) {
    Graph graph;
    const ObjectId cylinder = graph.primitive(PrimitiveKind::cylinder);
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const auto tree_id = static_cast<ObjectId>(graph.objects.size());
    Object tree = named("tree");
    tree.instances = {instance(cylinder, Affine::scale({.1, 1, .1})),
                      instance(tree_id, scaled(.5, {0, 1, 0}))};
    tree.terminal = instance(sphere, scaled(100, Vec3(0.0)));
    graph.add(std::move(tree));
    Object two = named("two");
    two.instances = {instance(tree_id, Affine::translate({5, 0, 0})), instance(sphere, Affine{})};
    graph.root = graph.add(std::move(two));
    const std::vector<ObjectBounds> found = bounds(graph);
    expect_box(found[tree_id].box, {-.1, 0, -.1}, {.1, 2, .1});
    expect_box(found[graph.root].box, {-1, -1, -1}, {5.1, 2, 1});
    EXPECT_LE(found[tree_id].ball.radius, 1.03);
}

TEST(Bounding, PlanesAreUnboundedAndLeaveTheRestBounded) {
    Graph graph;
    const ObjectId plane = graph.primitive(PrimitiveKind::plane);
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Object only = named("only");
    only.instances = {instance(plane, Affine{})};
    const ObjectId only_id = graph.add(std::move(only));
    Object both = named("both");
    both.instances = {instance(only_id, Affine{}), instance(sphere, scaled(2, {1, 0, 0}))};
    graph.root = graph.add(std::move(both));
    const std::vector<ObjectBounds> found = bounds(graph);
    EXPECT_TRUE(found[only_id].unbounded);
    EXPECT_TRUE(found[only_id].box.empty());
    EXPECT_TRUE(found[only_id].ball.empty());
    EXPECT_TRUE(found[graph.root].unbounded);
    expect_box(found[graph.root].box, {-1, -2, -2}, {3, 2, 2});
    EXPECT_NEAR(found[graph.root].ball.radius, 2, 1e-9);
    EXPECT_FALSE(found[sphere].unbounded);
}

} // namespace
} // namespace graftal
