#include "compiler/passes/split_into_halves.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/verify.h"

namespace graftal {
namespace {

/// The corners of a square or of three quarters of it, each a copy of the whole, and maybe something that
/// ends.
Graph corners(int count, bool with_ball) {
    Graph graph;
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    Object object;
    object.name = "tip(3)";
    const auto self = static_cast<ObjectId>(graph.objects.size());
    const Vec3 places[] = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
    for (int i = 0; i < count; ++i) {
        Instance instance;
        instance.master = self;
        instance.parent_from_child = Affine::translate(0.5 * places[i]) * Affine::scale(Vec3(0.5));
        object.instances.push_back(instance);
    }
    for (const double x : {-0.5, 0.5}) {
        if (!with_ball) break;
        Instance instance;
        instance.master = ball;
        instance.parent_from_child = Affine::translate({x, 0, 0}) * Affine::scale(Vec3(0.1));
        object.instances.push_back(instance);
    }
    graph.root = graph.add(std::move(object));
    return graph;
}

Rewritten halved(const Graph& graph) {
    const Components components = strong_components(graph);
    return split_into_halves(graph, bound_objects(graph, components, decide_contraction(graph, components)));
}

TEST(SplitIntoHalves, TakesItsOwnMirrorImageApart) {
    const Graph graph = corners(4, false);
    const auto [after, renumbering] = halved(graph);
    EXPECT_TRUE(verify(after).empty());
    ASSERT_EQ(after.objects.size(), graph.objects.size() + 2);
    const std::vector<Instance>& parts = after.objects[after.root].instances;
    ASSERT_EQ(parts.size(), 2u);
    for (const Instance& part : parts) {
        EXPECT_EQ(part.levels, 0u);
        EXPECT_EQ(part.parent_from_child, Affine());
        EXPECT_EQ(after.objects[part.master].instances.size(), 2u);
        EXPECT_EQ(renumbering.origin[part.master], graph.root);
    }
    EXPECT_EQ(after.objects[parts[0].master].name, "tip.half(3)");
    EXPECT_EQ(after.objects[parts[1].master].name, "tip.half2(3)");
}

TEST(SplitIntoHalves, WhatEndsStaysWithTheWhole) {
    const auto [after, renumbering] = halved(corners(4, true));
    const std::vector<Instance>& instances = after.objects[after.root].instances;
    ASSERT_EQ(instances.size(), 4u);
    EXPECT_EQ(instances[2].levels, levels_of_master);
    EXPECT_EQ(after.objects[instances[2].master].primitive, PrimitiveKind::sphere);
}

TEST(SplitIntoHalves, WhatHasNoMirrorStaysWhole) {
    for (const Graph& graph : {corners(3, false), corners(2, false)})
        EXPECT_TRUE(equal(halved(graph).graph, graph));
}

} // namespace
} // namespace graftal
