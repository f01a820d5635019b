#include "compiler/graph/unfold.h"
#include "tests/unit/broken_invariant.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

Instance instance_of(ObjectId master, const Affine& parent_from_child = {}) {
    Instance instance;
    instance.master = master;
    instance.parent_from_child = parent_from_child;
    return instance;
}

ObjectId add_union(Graph& graph, const std::string& name, std::vector<Instance> instances = {}) {
    Object object;
    object.name = name;
    object.instances = std::move(instances);
    return graph.add(std::move(object));
}

std::vector<UnfoldedLeaf> leaves(const Graph& graph, std::optional<unsigned> steps) {
    std::vector<UnfoldedLeaf> all;
    EXPECT_TRUE(unfold(graph, strong_components(graph), steps, 1'000'000, [&](const UnfoldedLeaf& leaf) {
        all.push_back(leaf);
        return true;
    }));
    return all;
}

/// The names of the leaves' objects in order, proxies with a question mark.
std::string drawn(const Graph& graph, std::optional<unsigned> steps) {
    std::string text;
    for (const UnfoldedLeaf& leaf : leaves(graph, steps))
        text += (text.empty() ? "" : " ") + graph.objects[leaf.object].name + (leaf.primitive ? "" : "?");
    return text;
}

TEST(Unfold, AnEndingGraphNeedsNoStepsAndHeedsNone) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere),
                   cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId pair = add_union(graph, "pair", {instance_of(sphere), instance_of(cube)});
    graph.root = add_union(graph, "root", {instance_of(pair), instance_of(cube), instance_of(pair)});
    graph.objects[pair].terminal = instance_of(sphere);
    for (const std::optional<unsigned> steps : {std::optional<unsigned>(), {0u}, {1u}, {1000000000u}})
        EXPECT_EQ(drawn(graph, steps), "sphere cube cube sphere cube")
            << "depth first, in the order of the text";
}

TEST(Unfold, APoundSignHasEightTimesSevenToTheStepsMinusOne) {
    Graph graph;
    std::vector<Instance> all;
    for (int i = 0; i < 8; ++i)
        all.push_back(instance_of(add_union(graph, "w" + std::to_string(i)), Affine::scale(Vec3(0.5))));
    for (ObjectId i = 0; i < 8; ++i)
        for (ObjectId j = 0; j < 8; ++j)
            if (j != i) graph.objects[i].instances.push_back(all[j]);
    graph.root = add_union(graph, "pound_sign", all);
    EXPECT_EQ(drawn(graph, 0), "pound_sign?");
    std::size_t expected = 8;
    for (unsigned steps = 1; steps <= 5; ++steps, expected *= 7)
        EXPECT_EQ(leaves(graph, steps).size(), expected) << steps << " steps";
}

TEST(Unfold, OnlyInstancesOfUnendingMastersAreLevels) {
    // wrapper -> loop -> loop; wrapper and root are unending, the leaf behind two unions is not.
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const ObjectId inner = add_union(graph, "inner", {instance_of(sphere)});
    const ObjectId leaf = add_union(graph, "leaf", {instance_of(inner)});
    const ObjectId loop = add_union(graph, "loop");
    graph.objects[loop].instances = {instance_of(leaf), instance_of(loop)};
    const ObjectId wrapper = add_union(graph, "wrapper", {instance_of(loop)});
    graph.root = add_union(graph, "root", {instance_of(wrapper)});
    EXPECT_EQ(drawn(graph, 0), "root?") << "nothing ending in it: a proxy";
    EXPECT_EQ(drawn(graph, 1), "wrapper?");
    EXPECT_EQ(drawn(graph, 2), "sphere") << "the loop is cut, and draws what ends";
    EXPECT_EQ(drawn(graph, 3), "sphere sphere");
    EXPECT_EQ(drawn(graph, 7), "sphere sphere sphere sphere sphere sphere");
}

TEST(Unfold, WhereCutTheTerminalComesFirstThenWhatEndsThenAProxy) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere),
                   cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId bark = add_union(graph, "bark", {instance_of(cube), instance_of(cube)});
    const ObjectId tree = add_union(graph, "tree");
    graph.root = tree;
    graph.objects[tree].instances = {instance_of(tree), instance_of(tree)};
    EXPECT_EQ(drawn(graph, 1), "tree? tree?");
    graph.objects[tree].instances.push_back(instance_of(bark));
    EXPECT_EQ(drawn(graph, 0), "cube cube");
    EXPECT_EQ(drawn(graph, 1), "cube cube cube cube cube cube");
    graph.objects[tree].terminal = instance_of(sphere);
    EXPECT_EQ(drawn(graph, 0), "sphere");
    EXPECT_EQ(drawn(graph, 1), "sphere sphere cube cube");
    graph.objects[tree].terminal = instance_of(bark);
    EXPECT_EQ(drawn(graph, 1), "cube cube cube cube cube cube");
}

TEST(Unfold, TransformsTintsAndMaterialsComposeAlongThePath) {
    Graph graph;
    graph.materials.resize(2);
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Instance outer = instance_of(0, Affine::translate({1, 0, 0})),
             inner = instance_of(0, Affine::scale(Vec3(0.5)));
    Instance shell = instance_of(sphere, Affine::rotate({0, 0, 1}, 90));
    outer.tint = {{1, 0, 0}, 0.5};
    inner.tint = {{0, 0, 1}, 0.5};
    outer.material = 0;
    shell.material = 1;
    const ObjectId leaf = add_union(graph, "leaf", {shell, instance_of(sphere)});
    inner.master = leaf;
    const ObjectId middle = add_union(graph, "middle", {inner});
    outer.master = middle;
    graph.root = add_union(graph, "root", {outer});

    const std::vector<UnfoldedLeaf> all = leaves(graph, {});
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].world_from_object,
              outer.parent_from_child * inner.parent_from_child * shell.parent_from_child);
    EXPECT_EQ(all[0].world_from_object(Vec3(1, 0, 0)), Vec3(1, 0.5, 0));
    EXPECT_EQ(all[0].tint, PathTint(outer.tint) * PathTint(inner.tint));
    EXPECT_EQ(all[0].tint.premultiplied, Rgb(0.5, 0, 0.25)) << "the parent in front";
    EXPECT_EQ(all[0].material, 1u) << "the nearest to the primitive wins";
    EXPECT_EQ(all[1].material, 0u) << "else the nearest above";
}

TEST(Unfold, TheTerminalsOwnPlacementCounts) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const ObjectId loop = add_union(graph, "loop");
    graph.objects[loop].instances = {instance_of(loop, Affine::scale(Vec3(0.5)))};
    graph.objects[loop].terminal = instance_of(sphere, Affine::translate({0, 1, 0}));
    graph.root = loop;
    const std::vector<UnfoldedLeaf> all = leaves(graph, 3);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].world_from_object, Affine::scale(Vec3(0.125)) * Affine::translate({0, 1, 0}));
    EXPECT_EQ(all[0].primitive, PrimitiveKind::sphere);
}

TEST(Unfold, StopsAtTheLimitAndWhereTheVisitorHasEnough) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    graph.root = add_union(graph, "root", {instance_of(sphere), instance_of(sphere), instance_of(sphere)});
    const auto visited = [&](std::uint64_t max_leaves, int stop_at, bool& complete) {
        int count = 0;
        complete = unfold(graph, strong_components(graph), {}, max_leaves,
                          [&](const UnfoldedLeaf&) { return ++count != stop_at; });
        return count;
    };
    bool complete = false;
    EXPECT_EQ(visited(3, 0, complete), 3);
    EXPECT_TRUE(complete) << "exactly as many as allowed";
    EXPECT_EQ(visited(2, 0, complete), 2);
    EXPECT_FALSE(complete);
    EXPECT_EQ(visited(0, 0, complete), 0);
    EXPECT_FALSE(complete);
    EXPECT_EQ(visited(9, 2, complete), 2);
    EXPECT_FALSE(complete);
}

TEST(Unfold, DepthIsNoLimit) {
    Graph graph;
    ObjectId master = graph.primitive(PrimitiveKind::sphere);
    for (int i = 0; i < 100'000; ++i)
        master = add_union(graph, "o" + std::to_string(i), {instance_of(master)});
    graph.root = master;
    EXPECT_EQ(leaves(graph, {}).size(), 1u);

    Graph loop;
    loop.root = add_union(loop, "loop", {instance_of(0, Affine::scale(Vec3(0.5)))});
    EXPECT_EQ(leaves(loop, 100'000).size(), 1u);
}

TEST(Unfold, AnEndlessFirstBranchDoesNotHideTheLimit) {
    // Each level holds one sphere; the visitor stops long before the depth.
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    graph.root = add_union(graph, "loop");
    graph.objects[graph.root].instances = {instance_of(sphere), instance_of(graph.root)};
    EXPECT_FALSE(unfold(graph, strong_components(graph), 4'000'000'000u, 1000,
                        [](const UnfoldedLeaf&) { return true; }));
}

TEST(Unfold, AnUnendingGraphWithoutStepsIsABug) {
    Graph graph;
    graph.root = add_union(graph, "loop", {instance_of(0)});
    EXPECT_BROKEN(leaves(graph, {}), "an unending graph without steps");
}

} // namespace
} // namespace graftal
