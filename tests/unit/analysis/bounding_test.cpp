#include "compiler/analysis/bounding.h"

#include <cmath>
#include <ctime>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/analysis/smallest_ball.h"
#include "tests/unit/analysis/sampling.h"
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

/// Near, and never inside.
void expect_box(const Box& box, Vec3 min, Vec3 max, double tolerance = 1e-9) {
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(box.min[i], min[i], tolerance) << "axis " << i;
        EXPECT_NEAR(box.max[i], max[i], tolerance) << "axis " << i;
        EXPECT_LE(box.min[i], min[i] + 1e-15) << "axis " << i;
        EXPECT_GE(box.max[i], max[i] - 1e-15) << "axis " << i;
    }
}

bool inside(const ObjectBounds& bounds, Vec3 point) {
    for (int i = 0; i < 3; ++i)
        if (!(point[i] >= bounds.box.min[i] && point[i] <= bounds.box.max[i])) return false;
    return glm::length(point - bounds.ball.centre) <= bounds.ball.radius * (1 + 1e-14);
}

double smallest_radius(const std::vector<Vec3>& points) {
    std::vector<Ball> balls;
    for (const Vec3 point : points)
        balls.push_back({point, 0});
    return smallest_ball(balls).radius;
}

/// Random points of every object lie inside; those of the root come near each face of the box and leave
/// little room in the ball.
void expect_outer_and_tight(const Graph& graph, double room_in_box, double room_in_ball) {
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

TEST(Bounding, BoxesOfKnownLimitSets) {
    const double s = std::numbers::sqrt3 / 2, third = 1.0 / 3;
    expect_box(root_bounds(pound_sign(3)).box, Vec3(-1.0), Vec3(1.0));
    expect_box(root_bounds(pound_sign(2)).box, {-1, -1, 0}, {1, 1, 0});
    expect_box(root_bounds(ifs(menger_maps())).box, Vec3(-1.0), Vec3(1.0));
    expect_box(root_bounds(menger_digraph()).box, Vec3(-1.0), Vec3(-third));
    expect_box(root_bounds(ifs(sierpinski_triangle())).box, {-s, -.5, 0}, {s, 1, 0});
    expect_box(root_bounds(ifs(sierpinski_tetrahedron())).box, Vec3(-1.0), Vec3(1.0));
    expect_box(root_bounds(ifs(twin_dragon())).box, {-2 * third, -third, 0}, {5 * third, 4 * third, 0});
    expect_box(root_bounds(ifs(heighway_dragon())).box, {-third, -third, 0}, {7.0 / 6, 2 * third, 0});
    expect_box(root_bounds(ifs(levy_curve())).box, {-.5, -.25, 0}, {1.5, 1, 0});
    const Box fern = root_bounds(ifs(barnsley_fern())).box;
    EXPECT_NEAR(fern.min.x, -2.1819, 5e-5);
    EXPECT_NEAR(fern.max.x, 2.6558, 5e-5);
    EXPECT_NEAR(fern.min.y, 0, 1e-9);
    EXPECT_NEAR(fern.max.y, 9.9983, 5e-5);
    EXPECT_LE(root_bounds(ifs(barnsley_fern())).ball.radius, 5.072 * 1.03);
}

TEST(Bounding, ASheardNodeIsBoundedThoughItsNormExpands) {
    const Graph graph =
        ifs({plane_map(.5, 2, 0, .5, 0, 0), plane_map(.5, 2, 0, .5, 1, 0), plane_map(.5, 2, 0, .5, 0, 1)});
    expect_box(root_bounds(graph).box, {0, 0, 0}, {9, 2, 0});
    expect_outer_and_tight(graph, 0.06, 0.08);
}

TEST(Bounding, LimitSetsFillTheirBounds) {
    expect_outer_and_tight(pound_sign(2), 0.02, 0.03);
    expect_outer_and_tight(pound_sign(3), 0.03, 0.04);
    expect_outer_and_tight(menger_digraph(), 0.02, 0.03);
    expect_outer_and_tight(ifs(sierpinski_tetrahedron()), 0.02, 0.02);
    expect_outer_and_tight(ifs(barnsley_fern()), 0.03, 0.04);
    expect_outer_and_tight(ifs(twin_dragon()), 0.02, 0.03);
    expect_outer_and_tight(ifs(heighway_dragon()), 0.02, 0.03);
    expect_outer_and_tight(ifs(levy_curve()), 0.02, 0.03);
}

TEST(Bounding, EdgesMayExpand) {
    const Affine turn = Affine::rotate({0, 0, 1}, 25);
    expect_outer_and_tight(digraph(2, {{0, 1, turn * scaled(2, {1, 0, 0})},
                                       {1, 0, turn * scaled(.2, {0, .5, 0})},
                                       {0, 0, scaled(.5, {.3, 0, 0})},
                                       {1, 0, scaled(.15, {0, -.5, .2})}}),
                           0.03, 0.04);
    // By twelve powers of ten, and back.
    const Graph units = digraph(2, {{0, 1, scaled(1e12, Vec3(1e12))},
                                    {1, 0, scaled(2e-13, Vec3(0.0))},
                                    {1, 0, turn * scaled(2e-13, Vec3(.5))}});
    expect_outer_and_tight(units, 0.03, 0.04);
}

TEST(Bounding, ADigraphThatForbidsTheExpandingOrder) {
    const Affine right = plane_map(.6, 1.5, 0, .6, 1, 0), up = plane_map(.6, 0, 1.5, .6, 0, 1);
    expect_outer_and_tight(
        digraph(2, {{0, 0, right}, {0, 1, right}, {1, 1, up}, {1, 1, linear_map(.1, 0, 0, .1)}}), 0.03, 0.06);
}

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

TEST(Bounding, PrimitivesAreExact) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int k = 0; k < primitive_kind_count; ++k) {
        const auto kind = static_cast<PrimitiveKind>(k);
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

Affine random_affine(std::mt19937& random, double size) {
    std::normal_distribution<double> normal(0, size);
    Affine map;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            map.linear[column][row] = normal(random);
    map.translation = {normal(random), normal(random), normal(random)};
    return map;
}

TEST(Bounding, EndingObjectsAreExact) {
    std::mt19937 random(3);
    for (int round = 0; round < 40; ++round) {
        Graph graph;
        for (int k = 0; k < primitive_kind_count; ++k)
            if (k != static_cast<int>(PrimitiveKind::plane)) graph.primitive(static_cast<PrimitiveKind>(k));
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

TEST(Bounding, RandomContractingSystemsLieInside) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    int deep = 0, proved = 0;
    while (proved < 80) {
        Graph graph;
        const ObjectId cone = graph.primitive(PrimitiveKind::cone);
        for (int i = 0; i < 3; ++i)
            graph.add(named(numbered("o", static_cast<std::size_t>(i))));
        for (ObjectId e = 0; e < 6; ++e)
            graph.objects[1 + e % 3].instances.push_back(
                instance(e < 3 ? 1 + (e + 1) % 3 : 1 + static_cast<ObjectId>(random() % 3),
                         random_affine(random, .38)));
        if (proved % 2 == 0) graph.objects[1].instances.push_back(instance(cone, random_affine(random, 1)));
        Object above = named("above");
        above.instances = {instance(2, random_affine(random, 1)), instance(3, random_affine(random, 1)),
                           instance(cone, random_affine(random, .1))};
        graph.root = graph.add(std::move(above));
        const Components components = strong_components(graph);
        const Contraction contraction = decide_contraction(graph, components);
        if (contraction.verdict != Verdict::proved || contraction.lower > .97) continue;
        ++proved;
        deep += contraction.certificate.depth > 1;
        const std::vector<ObjectBounds> found = bound_objects(graph, components, contraction);
        for (ObjectId id = 1; id < graph.objects.size(); ++id)
            for (const Vec3 point : random_points(graph, id, 300, id))
                ASSERT_TRUE(inside(found[id], point))
                    << "system " << proved << ", " << graph.objects[id].name;
        const double reach = smallest_radius(random_points(graph, graph.root, 5000, 1));
        EXPECT_LE(found[graph.root].ball.radius, 2 * reach);
    }
    EXPECT_GE(deep, 3);
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

TEST(Bounding, ComponentsAboveComponents) {
    Graph graph = digraph(
        3,
        {{0, 0, scaled(.5, {1, 0, 0})}, {0, 1, scaled(1, {0, 3, 0})}, {2, 0, Affine::rotate({0, 0, 1}, 90)}});
    for (const Affine& map : sierpinski_triangle())
        graph.objects[1].instances.push_back(instance(1, map));
    graph.root = 2;
    // 0 holds the triangle at (0,3), (1,1.5) at half size, (1.5,.75) at a quarter, ... down to (2,0).
    const double s = std::numbers::sqrt3 / 2;
    expect_box(bounds(graph)[0].box, {-s, 0, 0}, {2, 4, 0});
    expect_box(root_bounds(graph).box, {-4, -s, 0}, {0, 2, 0});
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
    const std::clock_t start = std::clock();
    const Graph turning = chain(100'000, [&](std::size_t i) {
        return Affine::translate({0, 1, 0}) * turn(i) * scaled(.99, Vec3(0.0));
    });
    const ObjectBounds found = root_bounds(turning);
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10);
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

TEST(Bounding, IsTheSameEveryTime) {
    const std::vector<ObjectBounds> first = bounds(menger_digraph()), second = bounds(menger_digraph());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].box, second[i].box);
        EXPECT_EQ(first[i].ball, second[i].ball);
    }
}

TEST(SmallestBall, HoldsAllAndIsTheSmallest) {
    EXPECT_TRUE(smallest_ball({}).empty());
    const std::vector<Ball> one{{{1, 2, 3}, 4}};
    EXPECT_EQ(smallest_ball(one), one.front());
    const std::vector<Ball> inner{{{1, 0, 0}, 1}, {{0, 0, 0}, 5}, {{0, 0, 0}, 5}};
    EXPECT_NEAR(smallest_ball(inner).radius, 5, 1e-12);
    const std::vector<Ball> two{{{-3, 0, 0}, 1}, {{4, 0, 0}, 2}};
    EXPECT_NEAR(smallest_ball(two).radius, 5, 1e-9);
    EXPECT_NEAR(smallest_ball(two).centre.x, 1, 1e-9);
    std::vector<Ball> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({Vec3(i & 1, i >> 1 & 1, i >> 2 & 1), 0});
    EXPECT_NEAR(smallest_ball(corners).radius, std::sqrt(.75), 1e-9);
}

TEST(SmallestBall, IsLocallySmallestOnRandomBalls) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (int round = 0; round < 300; ++round) {
        std::vector<Ball> balls;
        for (int i = 0; i < 2 + round % 30; ++i)
            balls.push_back({{normal(random), normal(random), round % 3 == 0 ? 0 : normal(random)},
                             round % 2 == 0 ? 0 : std::abs(normal(random))});
        const Ball found = smallest_ball(balls);
        const auto needed = [&](Vec3 centre) {
            double radius = 0;
            for (const Ball& ball : balls)
                radius = std::max(radius, glm::length(ball.centre - centre) + ball.radius);
            return radius;
        };
        EXPECT_GE(found.radius, needed(found.centre) * (1 - 1e-15));
        for (int i = 0; i < 50; ++i) { // the needed radius is convex in the centre
            const Vec3 step(normal(random), normal(random), normal(random));
            EXPECT_GE(needed(found.centre + 1e-4 * step), found.radius * (1 - 1e-8));
        }
    }
}

} // namespace
} // namespace graftal
