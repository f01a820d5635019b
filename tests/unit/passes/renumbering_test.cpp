#include "compiler/passes/renumbering.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/passes/merge_equivalent.h"
#include "compiler/passes/pipeline.h"

namespace graftal {
namespace {

Instance instance_of(ObjectId master, double x) {
    Instance instance;
    instance.master = master;
    instance.parent_from_child = Affine::translate({x, 0, 0}) * Affine::scale(Vec3(0.5));
    return instance;
}

/// Two equal objects whose instances come in different orders, one of them twice.
struct Twins {
    Graph graph;
    ObjectId first = 0, second = 0;

    Twins() {
        const ObjectId sphere = graph.primitive(PrimitiveKind::sphere),
                       cube = graph.primitive(PrimitiveKind::cube);
        first = graph.add(
            {"first", {}, {instance_of(sphere, 1), instance_of(cube, 2), instance_of(cube, 2)}, {}, {}});
        second = graph.add(
            {"second", {}, {instance_of(cube, 2), instance_of(sphere, 1), instance_of(cube, 2)}, {}, {}});
        graph.root = graph.add({"root", {}, {instance_of(first, 0), instance_of(second, 3)}, {}, {}});
    }
};

TEST(Renumbering, AnInstanceIsFollowedToTheOneThatDrawsIt) {
    const Twins twins;
    const Rewritten merged = merge_equivalent(twins.graph);
    const ObjectId now = merged.renumbering.now[twins.second];
    EXPECT_EQ(now, merged.renumbering.now[twins.first]);
    const std::vector<std::uint32_t> expected = {1, 0, 2};
    for (std::uint32_t i = 0; i < 3; ++i)
        EXPECT_EQ(
            followed(merged.renumbering, {twins.second, i}, twins.graph.objects[twins.second], merged.graph),
            (GraphStep{now, expected[i]}));
}

TEST(Renumbering, APathKeepsLeadingToTheSamePlace) {
    const Twins twins;
    const BoundedGraph after =
        run_passes(model_passes(), {twins.graph, {}, {{twins.graph.root, 1}, {twins.second, 1}}});
    ASSERT_EQ(after.path.size(), 2u);
    EXPECT_EQ(after.path[0].object, after.graph.root);
    const Instance& into = after.graph.objects[after.path[0].object].instances[after.path[0].instance];
    EXPECT_EQ(into.parent_from_child.translation, Vec3(3, 0, 0));
    EXPECT_EQ(into.master, after.path[1].object);
    const Instance& leaf = after.graph.objects[after.path[1].object].instances[after.path[1].instance];
    EXPECT_EQ(after.graph.objects[leaf.master].primitive, PrimitiveKind::sphere);
}

TEST(Renumbering, BoundsGoWithTheirObjects) {
    const Twins twins;
    std::vector<ObjectBounds> bounds(twins.graph.objects.size());
    for (std::size_t i = 0; i < bounds.size(); ++i)
        bounds[i].ball.radius = static_cast<double>(i);
    const Rewritten merged = merge_equivalent(twins.graph);
    const std::vector<ObjectBounds> carried = carried_over(merged.renumbering, bounds);
    ASSERT_EQ(carried.size(), merged.graph.objects.size());
    EXPECT_EQ(carried[merged.renumbering.now[twins.second]].ball.radius, twins.first);
    EXPECT_EQ(carried[merged.graph.root].ball.radius, twins.graph.root);
}

} // namespace
} // namespace graftal
