#include "compiler/graph/run.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/graph/graph.h"
#include "compiler/support/counter_random.h"

namespace graftal {
namespace {

RunItem segment(Vec3 base, Vec3 axis, double radius) {
    RunItem item;
    item.base = base;
    item.axis = axis;
    item.radius = radius;
    item.shape = PrimitiveKind::cylinder;
    item.ball = true;
    return item;
}

Graph of_run(const graftal::Run& run) {
    Graph graph;
    Object object;
    object.name = "m";
    auto copy = std::make_shared<graftal::Run>();
    for (std::size_t i = 0; i < run.size(); ++i)
        copy->add(run[i]);
    object.packed.run = std::move(copy);
    object.packed.materials.resize(1);
    graph.root = graph.add(std::move(object));
    return graph;
}

TEST(Run, ASegmentTakes64Bytes) {
    EXPECT_EQ(sizeof(RunItem), 64u);
}

TEST(Run, KeepsTheNumbersOfASegment) {
    const RunItem item = segment({1, 2, 3}, {0.1, -0.7, 0.3}, 0.05);
    const Affine body = run_from_body(item), ball = run_from_ball(item);
    EXPECT_EQ(body.translation, item.base);
    EXPECT_EQ(body.linear[1], item.axis);
    EXPECT_EQ(ball.translation, item.base + item.axis);
    for (const int column : {0, 2}) {
        EXPECT_NEAR(glm::length(body.linear[column]), 0.05, 1e-17);
        EXPECT_NEAR(glm::dot(body.linear[column], item.axis), 0, 1e-17);
    }
    EXPECT_NEAR(glm::determinant(body.linear), 0.05 * 0.05 * glm::length(item.axis), 1e-15);
}

TEST(Run, TurnsPicturesAsTheTurtleDoes) {
    for (int step = 0; step < 100; ++step) {
        const Affine turtle =
            Affine::rotate({0.3, 0.5, -0.7}, 7.3 * step) * Affine::rotate({0, 1, 0}, 11.0 * step);
        RunItem item = segment({}, 0.4 * turtle.linear[1], 2);
        item.turn = turn_of(item.axis, turtle.linear[0]);
        EXPECT_NEAR(glm::distance(run_from_body(item).linear[0], 2.0 * turtle.linear[0]), 0, 2 * 7.4e-10);
    }
}

TEST(Run, GrowsAndShrinks) {
    graftal::Run run;
    for (int i = 0; i < 40'000; ++i)
        run.add(segment({static_cast<double>(i), 0, 0}, {0, 1, 0}, 0.1));
    run.shrink_to_fit();
    EXPECT_EQ(run.size(), 40'000u);
    EXPECT_EQ(run.part_count(), 80'000u);
    for (const std::size_t i : {0u, 16'383u, 16'384u, 39'999u})
        EXPECT_EQ(run[i].base.x, static_cast<double>(i));
    run.add(segment({7, 0, 0}, {0, 1, 0}, 0.1));
    EXPECT_EQ(run[40'000].base.x, 7);
    EXPECT_EQ(run[39'999].base.x, 39'999);
}

TEST(Run, EqualsTheInstancesThatItMeans) {
    graftal::Run run;
    run.add(segment({0, 0, 0}, {0, 1, 0}, 0.1));
    RunItem cone = segment({0, 1, 0}, {0, 0.5, 0.25}, 0.2);
    cone.shape = PrimitiveKind::cone;
    cone.ball = false;
    run.add(cone);
    const Graph with_run = of_run(run);
    EXPECT_EQ(edge_count(with_run), 3u);
    EXPECT_EQ(instance_count(with_run), 0u);

    Graph spelt;
    Object object;
    object.name = "m";
    spelt.root = spelt.add(std::move(object));
    const auto add = [&](const Primitive& kind, const Affine& place) {
        const ObjectId master = spelt.primitive(kind);
        spelt.objects[spelt.root].instances.push_back({master, place, {}, {}, {}});
    };
    add(PrimitiveKind::cylinder, run_from_body(run[0]));
    add(PrimitiveKind::sphere, run_from_ball(run[0]));
    EXPECT_FALSE(equal(with_run, spelt));
    add(PrimitiveKind::cone, run_from_body(run[1]));
    EXPECT_TRUE(equal(with_run, spelt));
    EXPECT_TRUE(equal(spelt, with_run));
    spelt.objects[spelt.root].instances.back().parent_from_child.translation.x = 1e-300;
    EXPECT_FALSE(equal(with_run, spelt));
}

TEST(PackedEdges, AreMadeWhereTheyAreLookedAt) {
    auto run = std::make_shared<graftal::Run>();
    run->add(segment({0, 0, 0}, {0, 1, 0}, 0.1));
    RunItem cone = segment({0, 1, 0}, {0, 0.5, 0.25}, 0.2);
    cone.shape = PrimitiveKind::cone;
    cone.ball = false;
    cone.colour = 1;
    run->add(cone);
    PackedEdges edges{run, {std::nullopt, MaterialId{7}}};
    std::vector<PackedEdge> made;
    for (const PackedEdge& edge : edges)
        made.push_back(edge);
    ASSERT_EQ(made.size(), 3u);
    EXPECT_EQ(edges.size(), 3u);
    EXPECT_EQ(made[0].primitive, PrimitiveKind::cylinder);
    EXPECT_EQ(made[0].parent_from_child, run_from_body((*run)[0]));
    EXPECT_EQ(made[0].material, std::nullopt);
    EXPECT_EQ(made[1].primitive, PrimitiveKind::sphere);
    EXPECT_EQ(made[1].parent_from_child, run_from_ball((*run)[0]));
    EXPECT_EQ(made[2].primitive, PrimitiveKind::cone);
    EXPECT_EQ(made[2].parent_from_child, run_from_body(cone));
    EXPECT_EQ(made[2].material, MaterialId{7});
    EXPECT_EQ(edges.item_count(), 2u);
    EXPECT_EQ(edges.material_of_item(1), MaterialId{7});
    EXPECT_EQ(edges.unsound_item(), std::nullopt);
    edges.materials.pop_back();
    EXPECT_EQ(edges.unsound_item(), 1u);
}

TEST(PackedEdges, OfNoRunAreNone) {
    const PackedEdges edges;
    EXPECT_FALSE(edges);
    EXPECT_EQ(edges.size(), 0u);
    EXPECT_EQ(edges.begin(), edges.end());
    EXPECT_EQ(edges.unsound_item(), std::nullopt);
}

TEST(Run, KnowsWhatIsSound) {
    const RunItem good = segment({}, {0, 1, 0}, 1);
    EXPECT_TRUE(is_sound(good));
    RunItem item = good;
    item.radius = 0;
    EXPECT_FALSE(is_sound(item));
    item = good;
    item.axis = Vec3(0.0);
    EXPECT_FALSE(is_sound(item));
    item = good;
    item.base.y = std::nan("");
    EXPECT_FALSE(is_sound(item));
    item = good;
    item.shape = PrimitiveKind::cube;
    EXPECT_FALSE(is_sound(item));
}

/// The mean length of the step from an item to the next.
double mean_step(const graftal::Run& run) {
    double sum = 0;
    for (std::size_t i = 1; i < run.size(); ++i)
        sum += glm::distance(run[i - 1].base, run[i].base);
    return sum / static_cast<double>(run.size() - 1);
}

TEST(Run, IsOrderedInSpaceWhereItsItemsLieAnyhow) {
    const CounterRandom random(5);
    graftal::Run run;
    std::vector<double> before, after;
    constexpr std::size_t count = 40'000; // of several chunks
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto number = [&](std::uint64_t k) { return CounterRandom::unit(random(3 * i + k)); };
        run.add(segment({number(0), number(1), number(2)}, {0, 0.001, 0}, 0.01));
        before.push_back(run[i].base.x);
    }
    EXPECT_GT(mean_step(run), 0.5);
    order_in_space(run);
    EXPECT_LT(mean_step(run), 0.1);
    ASSERT_EQ(run.size(), count);
    for (std::size_t i = 0; i < count; ++i)
        after.push_back(run[i].base.x);
    std::ranges::sort(before);
    std::ranges::sort(after);
    EXPECT_EQ(before, after);
}

TEST(Run, KeepsItsOrderWhereItGoesThroughSpace) {
    graftal::Run run;
    constexpr int count = 20'000;
    for (int i = 0; i < count; ++i) // a coil
        run.add(segment({std::cos(0.01 * i), 0.001 * i, std::sin(0.01 * i)}, {0, 0.001, 0}, 0.01));
    order_in_space(run);
    for (int i = 0; i < count; ++i)
        ASSERT_EQ(run[static_cast<std::size_t>(i)].base.y, 0.001 * i);
}

} // namespace
} // namespace graftal
