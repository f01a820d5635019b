#include "compiler/analysis/bounding.h"

#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/analysis/support_query.h"
#include "tests/unit/analysis/bounds_checks.h"
#include "tests/unit/analysis/sampling.h"
#include "tests/unit/analysis/systems.h"

namespace graftal {
namespace {

using namespace test;

TEST(Bounding, SingularMaps) {
    Affine onto_line;
    onto_line.linear = Mat3(0.0);
    onto_line.linear[0] = {.5, .5, 0};
    onto_line.translation = {0, 0, 1};
    expect_outer_and_tight(ifs({onto_line, scaled(.3, Vec3(1.0)), Affine::rotate({1, 1, 0}, 50) * onto_line}),
                           0.02, 0.04);
    Affine step_down;
    step_down.linear = Mat3(0.0);
    step_down.linear[1][0] = 100;
    step_down.translation = {1, 1, 0};
    expect_box(root_bounds(ifs({step_down})).box, {101, 1, 0}, {101, 1, 0});
}

// All of the part lies at minus infinity, as far as numbers go: the search finds no point of it, and must not
// take one that it found before (of an instance that there need not be).
TEST(Bounding, NothingIsReachedWhereAllOverflows) {
    Graph graph;
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    Object pair = named("pair"), far = named("far");
    for (const double x : {0.0, 5.0})
        pair.instances.push_back(instance(ball, scaled(1, {x, 0, 0})));
    const ObjectId pair_id = graph.add(std::move(pair));
    for (const double factor : {1e200, 1e201})
        far.instances.push_back(instance(pair_id, scaled(factor, Vec3(0.0))));
    graph.root = graph.add(std::move(far));
    Outers outers(graph.objects.size());
    for (const ObjectId id : {ball, pair_id}) {
        outers[id].empty = false;
        outers[id].set_ball({Vec3(0.0), 6});
        outers[id].point_count = 1;
    }
    SupportSearch search(graph, outers);
    EXPECT_EQ(search.run(pair_id, {1, 0, 0}, 0, 100).point, Vec3(6, 0, 0));
    outers[pair_id].points[0] = {-1e139, 0, 0};
    EXPECT_EQ(search.run(graph.root, {1, 0, 0}, 0, 100).point, Vec3(0.0));
}

TEST(Bounding, APointIsBoundedToRounding) {
    const Graph graph = ifs({Affine::rotate({1, 2, 3}, 70) * scaled(.9, {1, 2, 3})});
    const ObjectBounds found = root_bounds(graph);
    EXPECT_TRUE(inside(found, random_points(graph, 0, 1, 1).front()));
    EXPECT_LE(glm::length(found.box.size()), 1e-10);
    EXPECT_LE(found.ball.radius, 1e-10);
}

TEST(Bounding, SlowSpirals) {
    const Affine turn = Affine::rotate({0, 0, 1}, 20) * scaled(.999, Vec3(0.0));
    const Graph graph = ifs({turn, scaled(.5, {1, 0, 0})});
    const ObjectBounds found = root_bounds(graph);
    EXPECT_GE(found.box.max.x, 2); // the fixed point of the second map
    EXPECT_LE(found.box.max.x, 2 + 1e-6);
    EXPECT_LE(found.box.size().z, 1e-6);
    std::mt19937 random(1);
    for (int i = 0; i < 30; ++i)
        EXPECT_TRUE(inside(found, Sampler(graph).point(0, random, 60'000)));
}

TEST(Bounding, FarFromTheOriginNothingIsLost) {
    const Graph graph = ifs({scaled(.5, Vec3(5e8)), scaled(.5, Vec3(5e8) + Vec3(.5, 0, 0))});
    const Box box = root_bounds(graph).box;
    EXPECT_LE(box.min.x, 1e9);
    EXPECT_GE(box.max.x, 1e9 + 1);
    EXPECT_NEAR(box.size().x, 1, 1e-4);
    // A detour by a billion and back rounds at its own size.
    const Graph detour = digraph(2, {{0, 1, Affine::rotate({0, 0, 1}, 30) * scaled(.5, {1e9, 0, 0})},
                                     {1, 0, scaled(.5, {-2e9, 0, 0})},
                                     {1, 0, scaled(.5, {-2e9, 1, 0})}});
    const std::vector<ObjectBounds> found = bounds(detour);
    for (const Vec3 point : random_points(detour, 0, 1000, 5))
        EXPECT_TRUE(inside(found[0], point));
}

Graph chain(std::size_t size, const std::function<Affine(std::size_t)>& map, int copies = 1) {
    Graph graph;
    const ObjectId cylinder = graph.primitive(PrimitiveKind::cylinder);
    ObjectId below = cylinder;
    for (std::size_t i = 0; i < size; ++i) {
        Object object = named(numbered("c", i));
        object.instances.push_back(instance(cylinder, Affine{}));
        for (int k = 0; k < copies; ++k)
            object.instances.push_back(instance(below, Affine::rotate({0, 1, 0}, 120 * k) * map(i)));
        below = graph.add(std::move(object));
    }
    graph.root = below;
    return graph;
}

TEST(Bounding, LongChainsTakeLittleTime) {
    const auto turn = [](std::size_t i) { return Affine::rotate({1, 2, 3}, static_cast<double>(i % 50)); };
    expect_box(root_bounds(chain(100'000,
                                 [](std::size_t) {
                                     return Affine::translate({0, 1, 0});
                                 }))
                   .box,
               {-1, 0, -1}, {1, 100'001, 1}, 1e-1);
    const Graph turning = chain(100'000, [&](std::size_t i) {
        return Affine::translate({0, 1, 0}) * turn(i) * scaled(.99, Vec3(0.0));
    });
    const ObjectBounds found = root_bounds(turning);
    for (const Vec3 point : random_points(turning, turning.root, 200, 3))
        EXPECT_TRUE(inside(found, point));
}

TEST(Bounding, ExponentiallyManyLeavesAreFoldedNotVisited) {
    const Graph tree = chain(
        2000,
        [](std::size_t i) {
            return Affine::translate({0, 1, 0}) * Affine::rotate({0, 1, 0}, 7.0 * static_cast<double>(i)) *
                   Affine::rotate({1, 0, 0}, 30) * scaled(.7, Vec3(0.0));
        },
        3);
    const ObjectBounds found = root_bounds(tree);
    for (const Vec3 point : random_points(tree, tree.root, 2000, 3))
        ASSERT_TRUE(inside(found, point));
    EXPECT_LT(found.box.max.y, 3.3);
    EXPECT_LT(found.ball.radius, 2.1);
}

TEST(Bounding, LongCyclesAreBounded) {
    const Graph graph = long_cycle(20'000, [](std::size_t i) {
        return Affine::rotate({1, 2, static_cast<double>(i)}, 31) * scaled(i % 100 == 77 ? .5 : 1, Vec3(1.0));
    });
    const std::vector<ObjectBounds> found = bounds(graph);
    std::mt19937 random(1);
    for (const ObjectId id : {0u, 1u, 9'999u, 19'999u})
        EXPECT_TRUE(inside(found[id], Sampler(graph).point(id, random, 60'000)));
    EXPECT_LT(found[0].ball.radius, 1);
}

TEST(Bounding, SizesOutOfRangeEndInNumbers) {
    const auto finite = [](const ObjectBounds& b) {
        return std::isfinite(glm::length(b.box.min)) && std::isfinite(glm::length(b.box.max)) &&
               std::isfinite(b.ball.radius) && std::isfinite(glm::length(b.ball.centre));
    };
    const Graph up_and_down =
        long_cycle(3000, [](std::size_t i) { return scaled(i < 1500 ? 2 : .49, Vec3(1.0)); });
    for (const ObjectBounds& found : bounds(up_and_down))
        ASSERT_TRUE(finite(found));
    const Graph growing = chain(3000, [](std::size_t) { return scaled(2, Vec3(1.0)); });
    for (const ObjectBounds& found : bounds(growing))
        ASSERT_TRUE(finite(found));
    const Graph turning = chain(
        3000,
        [](std::size_t i) {
            return Affine::rotate({1, 2, 3}, static_cast<double>(i)) * scaled(3, Vec3(1e300));
        },
        3);
    for (const ObjectBounds& found : bounds(turning))
        ASSERT_TRUE(finite(found));
    const Graph shrinking = chain(
        3000, [](std::size_t) { return scaled(.001, Vec3(1e-300)); }, 2);
    for (const ObjectBounds& found : bounds(shrinking))
        ASSERT_TRUE(finite(found));
}

} // namespace
} // namespace graftal
