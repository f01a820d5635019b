#include "compiler/passes/pipeline.h"

#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/passes/drop_unreachable.h"
#include "compiler/passes/merge_equivalent.h"
#include "tests/unit/broken_invariant.h"

namespace graftal {
namespace {

Instance instance_of(ObjectId master, const Affine& parent_from_child = Affine::scale(Vec3(0.5))) {
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

std::vector<std::string> names(const Graph& graph) {
    std::vector<std::string> all;
    for (const Object& object : graph.objects)
        all.push_back(object.name);
    return all;
}

using Names = std::vector<std::string>;

TEST(DropUnreachable, KeepsWhatTheRootLeadsToByInstancesAndTerminals) {
    Graph graph;
    const ObjectId lost = add_union(graph, "lost");
    const ObjectId cone = graph.primitive(PrimitiveKind::cone);
    const ObjectId leaf = add_union(graph, "leaf", {instance_of(cone)});
    const ObjectId root = add_union(graph, "root");
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    graph.objects[lost].instances = {instance_of(root), instance_of(cube), instance_of(lost)};
    graph.objects[root].instances = {instance_of(root)};
    graph.objects[root].terminal = instance_of(leaf);
    graph.root = root;
    const Graph kept = drop_unreachable(graph).graph;
    EXPECT_EQ(names(kept), (Names{"cone", "leaf", "root"}));
    EXPECT_EQ(kept.objects[kept.root].name, "root");
    EXPECT_EQ(kept.objects[kept.objects[kept.root].terminal->master].name, "leaf");
    EXPECT_EQ(kept.objects[kept.root].instances[0].master, kept.root);
    EXPECT_TRUE(equal(drop_unreachable(kept).graph, kept));
}

TEST(MergeEquivalent, KeepsApartWhatRandomPointsTellApart) {
    const auto merged_count = [](double a, double b, double c, double d) {
        Graph graph;
        const ObjectId cone = graph.primitive(PrimitiveKind::cone),
                       cube = graph.primitive(PrimitiveKind::cube);
        std::vector<ObjectId> parts;
        for (const auto& [first, second] : {std::pair(a, b), std::pair(c, d)}) {
            Instance one = instance_of(cone), other = instance_of(cube);
            one.chance = first, other.chance = second;
            parts.push_back(add_union(graph, "part" + std::to_string(parts.size()), {one, other}));
        }
        graph.root = add_union(graph, "root", {instance_of(parts[0]), instance_of(parts[1])});
        return merge_equivalent(graph).graph.objects.size();
    };
    EXPECT_EQ(merged_count(0, 0, 0, 0), 4u);
    EXPECT_EQ(merged_count(0.2, 0.8, 0.2, 0.8), 4u);
    EXPECT_EQ(merged_count(0.1, 0.4, 0.2, 0.8), 4u) << "the same, relative to each other";
    EXPECT_EQ(merged_count(0.2, 0.8, 0.8, 0.2), 5u);
    EXPECT_EQ(merged_count(0.2, 0.8, 0, 0), 5u) << "by size";
}

TEST(DropUnreachable, KeepsTheMaterialsThatAreUsedAndTheGrounds) {
    Graph graph;
    for (const char* name : {"unused", "of_instance", "of_terminal", "of_ground", "of_lost"}) {
        graph.materials.push_back({});
        graph.materials.back().name = name;
    }
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Instance instance = instance_of(sphere), terminal = instance, lost = instance;
    instance.material = 1;
    terminal.material = 2;
    lost.material = 4;
    graph.root = add_union(graph, "root", {instance});
    graph.objects[graph.root].terminal = terminal;
    add_union(graph, "lost", {lost});
    graph.settings.ground = GroundSetting{0, "of_ground", {}};
    const Graph kept = drop_unreachable(graph).graph;
    ASSERT_EQ(kept.materials.size(), 3u);
    EXPECT_EQ(kept.materials[*kept.objects[kept.root].instances[0].material].name, "of_instance");
    EXPECT_EQ(kept.materials[*kept.objects[kept.root].terminal->material].name, "of_terminal");
    EXPECT_EQ(kept.materials[2].name, "of_ground");
}

/// Hart's gasket (1992, figure 3): one object by itself three times.
ObjectId add_gasket(Graph& graph, const std::string& name) {
    const ObjectId gasket = add_union(graph, name);
    const Affine half = Affine::scale(Vec3(0.5));
    for (const Vec3 corner : {Vec3(0, 0.5, 0), Vec3(-0.4, -0.3, 0), Vec3(0.4, -0.3, 0)})
        graph.objects[gasket].instances.push_back(instance_of(gasket, Affine::translate(corner) * half));
    return gasket;
}

TEST(ClassesOfShape, ColoursMaterialsAndTerminalsDoNotTellApart) {
    Graph graph;
    const ObjectId a = add_gasket(graph, "a"), b = add_gasket(graph, "b"), c = add_gasket(graph, "c"),
                   d = add_gasket(graph, "d");
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    graph.materials = {Material()};
    for (Instance& instance : graph.objects[b].instances)
        instance.tint = {Rgb(1, 0, 0), 0.5};
    graph.objects[b].instances[0].master = a;
    graph.objects[c].instances[1].material = 0;
    graph.objects[c].terminal = instance_of(cube);
    graph.objects[d].instances[2].parent_from_child = Affine::scale(Vec3(0.4));
    graph.root = add_union(graph, "root", {instance_of(a), instance_of(b), instance_of(c), instance_of(d)});
    const ShapeClasses classes = classes_of_shape(graph);
    EXPECT_EQ(classes.class_of[b], classes.class_of[a]);
    EXPECT_EQ(classes.class_of[c], classes.class_of[a]);
    EXPECT_NE(classes.class_of[d], classes.class_of[a]) << "its third map is another one";
    EXPECT_EQ(classes.first, (std::vector<ObjectId>{a, d, cube, graph.root}));
}

TEST(MergeEquivalent, TwoGasketsAreOne) {
    Graph graph;
    const ObjectId a = add_gasket(graph, "first");
    const ObjectId b = add_gasket(graph, "second");
    graph.root = add_union(graph, "root", {instance_of(b), instance_of(a, Affine())});
    const Graph merged = merge_equivalent(graph).graph;
    EXPECT_EQ(names(merged), (Names{"first", "root"}));
    EXPECT_EQ(merged.objects[merged.root].name, "root");
    for (const Instance& instance : merged.objects[merged.root].instances)
        EXPECT_EQ(merged.objects[instance.master].name, "first");
}

TEST(MergeEquivalent, ACycleUnrolledIsTheCycle) {
    // Two gaskets that contain each other, and one that contains either: all three are the gasket.
    Graph graph;
    const ObjectId a = add_gasket(graph, "a"), b = add_gasket(graph, "b"), c = add_gasket(graph, "c");
    for (Instance& instance : graph.objects[a].instances)
        instance.master = b;
    for (Instance& instance : graph.objects[b].instances)
        instance.master = a;
    graph.objects[c].instances[1].master = a;
    graph.objects[c].instances[2].master = b;
    graph.root = c;
    const Graph merged = merge_equivalent(graph).graph;
    EXPECT_EQ(names(merged), (Names{"a"})) << "the first in the text keeps its name";
    for (const Instance& instance : merged.objects[0].instances)
        EXPECT_EQ(instance.master, 0u);
    EXPECT_EQ(merged.root, 0u);
}

TEST(MergeEquivalent, OneDifferenceDeepInsideKeepsCyclesApart) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere),
                   cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId a = add_gasket(graph, "a"), b = add_gasket(graph, "b");
    const ObjectId c = add_union(graph, "c", {instance_of(sphere)}),
                   d = add_union(graph, "d", {instance_of(cube)});
    graph.objects[a].instances.push_back(instance_of(c));
    graph.objects[b].instances.push_back(instance_of(d));
    graph.root = add_union(graph, "root", {instance_of(a), instance_of(b)});
    EXPECT_EQ(merge_equivalent(graph).graph.objects.size(), graph.objects.size());
    graph.objects[d].instances[0].master = sphere;
    EXPECT_EQ(names(merge_equivalent(graph).graph), (Names{"sphere", "cube", "a", "c", "root"}));
}

TEST(MergeEquivalent, EverythingThatIsDrawnCounts) {
    Graph base;
    base.materials.resize(2);
    base.materials[0].name = "m0";
    base.materials[1].name = "m1";
    const ObjectId sphere = base.primitive(PrimitiveKind::sphere);
    Instance instance = instance_of(sphere);
    instance.tint = {{0, 1, 0}, 0.5};
    instance.material = 0;
    const ObjectId a = add_union(base, "a", {instance, instance_of(sphere, Affine())});
    const ObjectId b = add_union(base, "b", {instance, instance_of(sphere, Affine())});
    base.root = add_union(base, "root", {instance_of(a), instance_of(b)});

    const auto merges_after = [&](auto change) {
        Graph graph = base;
        change(graph.objects[b]);
        return merge_equivalent(graph).graph.objects.size() < graph.objects.size();
    };
    EXPECT_TRUE(merges_after([](Object&) {}));
    EXPECT_TRUE(merges_after([](Object& o) { std::swap(o.instances[0], o.instances[1]); }))
        << "a union has no order";
    EXPECT_TRUE(merges_after([](Object& o) { o.instances[0].parent_from_child.translation.y = -0.0; }));
    EXPECT_TRUE(merges_after([](Object& o) {
        o.span = o.instances[0].span = {0, 3, 4};
    })) << "spans are not drawn";
    EXPECT_FALSE(merges_after([](Object& o) { o.instances[0].parent_from_child.translation.y = 1e-300; }));
    EXPECT_FALSE(merges_after([](Object& o) { o.instances[0].tint.alpha = 0.25; }));
    EXPECT_FALSE(merges_after([](Object& o) { o.instances[0].material = 1; }));
    EXPECT_FALSE(merges_after([](Object& o) { o.instances[0].material.reset(); }));
    EXPECT_FALSE(merges_after([](Object& o) { o.instances.push_back(o.instances[0]); }))
        << "a multiset, no set";
    EXPECT_FALSE(merges_after([](Object& o) { o.terminal = o.instances[0]; }));
    EXPECT_FALSE(merges_after([](Object& o) {
        o.terminal = o.instances[0];
        o.instances.erase(o.instances.begin());
    })) << "a terminal is no instance";
}

TEST(MergeEquivalent, AChainWhereEachRoundPeelsOneObjectIsFast) {
    constexpr ObjectId length = 100'000;
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    for (int copy = 0; copy < 2; ++copy) {
        ObjectId master = sphere;
        for (ObjectId i = 0; i < length; ++i)
            master = add_union(graph, (copy ? "b" : "a") + std::to_string(i),
                               {instance_of(master), instance_of(master)});
        graph.root = master;
    }
    const Graph merged = merge_equivalent(graph).graph; // quadratic time would take minutes
    EXPECT_EQ(merged.objects.size(), length + 1);
    EXPECT_EQ(merged.objects[merged.root].name, "a" + std::to_string(length - 1));
}

TEST(MergeEquivalent, ALongRingOfEqualsIsOneObject) {
    constexpr ObjectId length = 100'000;
    Graph graph;
    for (ObjectId i = 0; i < length; ++i)
        add_union(graph, "o" + std::to_string(i), {instance_of((i + 1) % length)});
    EXPECT_EQ(merge_equivalent(graph).graph.objects.size(), 1u);
    // One that is different makes all different: what follows it at some distance is.
    graph.objects[length / 2].instances[0].tint.alpha = 1;
    const Graph merged = merge_equivalent(graph).graph;
    EXPECT_EQ(merged.objects.size(), length);
}

TEST(MergeEquivalent, ManyUsersOfOneMasterAreFast) {
    constexpr int users = 200'000;
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const ObjectId root = add_union(graph, "root");
    graph.root = root;
    for (int i = 0; i < users; ++i) {
        const ObjectId user = add_union(graph, "o" + std::to_string(i),
                                        {instance_of(sphere, Affine::translate({i / 2 + 1.0, 0, 0}))});
        graph.objects[root].instances.push_back(instance_of(user));
    }
    const Graph merged = merge_equivalent(graph).graph;
    EXPECT_EQ(merged.objects.size(), users / 2 + 2u);
}

TEST(Pipeline, TheTableNamesEachPassOnce) {
    std::vector<std::string> all;
    for (const std::span<const Pass> passes : {model_passes(), detail_passes()})
        for (const Pass& pass : passes) {
            EXPECT_EQ(std::count(all.begin(), all.end(), pass.name), 0);
            EXPECT_STRNE(pass.summary, "");
            all.emplace_back(pass.name);
        }
    EXPECT_EQ(all, (Names{"drop_unreachable", "merge_equivalent", "hoist_placements",
                          "drop_unreachable_again", "merge_equivalent_again", "split_into_halves"}));
}

Graph two_gaskets_and_a_lost_object() {
    Graph graph;
    const ObjectId a = add_gasket(graph, "a"), b = add_gasket(graph, "b");
    add_union(graph, "lost", {instance_of(a)});
    graph.root = add_union(graph, "root", {instance_of(a), instance_of(b)});
    return graph;
}

Graph passed(const Graph& graph, const PipelineOptions& options = {},
             std::vector<PassTime>* times = nullptr) {
    return run_passes(model_passes(), {graph, {}}, options, times).graph;
}

TEST(Pipeline, RunsAllInOrderAndTimesThem) {
    std::vector<PassTime> times;
    Names seen;
    PipelineOptions options;
    options.after_each = [&](const Pass& pass, const Graph& graph) {
        seen.push_back(pass.name + std::string(" ") + std::to_string(graph.objects.size()));
    };
    const Graph graph = passed(two_gaskets_and_a_lost_object(), options, &times);
    EXPECT_EQ(names(graph), (Names{"a", "root"}));
    EXPECT_EQ(seen, (Names{"drop_unreachable 3", "merge_equivalent 2"}));
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[1].name, "merge_equivalent");
    EXPECT_GE(times[1].seconds, 0);
}

TEST(Pipeline, StopsAfterThePassAskedFor) {
    PipelineOptions options;
    options.stop_after = "drop_unreachable";
    EXPECT_EQ(names(passed(two_gaskets_and_a_lost_object(), options)), (Names{"a", "b", "root"}));
}

TEST(Pipeline, ABrokenGraphIsBlamedOnThePassAndTheObject) {
    Graph graph = two_gaskets_and_a_lost_object();
    graph.objects[graph.root].instances[1].tint.alpha = 3;
    EXPECT_BROKEN(passed(graph), "after pass drop_unreachable: object root: instance 1 has tint");
    PipelineOptions options;
    options.stop_after = "no_such_pass";
    EXPECT_BROKEN(passed(two_gaskets_and_a_lost_object(), options), "no pass 'no_such_pass'");
}

} // namespace
} // namespace graftal
