#include "compiler/analysis/bounding.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/analysis/bounds_checks.h"
#include "tests/unit/analysis/sampling.h"
#include "tests/unit/analysis/systems.h"

namespace graftal {
namespace {

using namespace test;

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
        digraph(2, {{0, 0, right}, {0, 1, right}, {1, 1, up}, {1, 1, linear_map(.1, 0, 0, .1)}}), 0.15, 0.1);
}

TEST(Bounding, RandomContractingSystemsLieInside) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    int deep = 0, proved = 0;
    while (proved < 50) {
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
    EXPECT_GE(deep, 2);
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

TEST(Bounding, IsTheSameEveryTime) {
    const std::vector<ObjectBounds> first = bounds(menger_digraph()), second = bounds(menger_digraph());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].box, second[i].box);
        EXPECT_EQ(first[i].ball, second[i].ball);
    }
}

} // namespace
} // namespace graftal
