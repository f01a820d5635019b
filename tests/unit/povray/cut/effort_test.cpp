#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/symmetry.h"
#include "compiler/detail/weights.h"
#include "compiler/povray/cut/calibrate.h"
#include "compiler/povray/cut/choose.h"
#include "tests/unit/detail/models.h"

// What is spent on a graph before anything of it is unfolded.

namespace graftal {
namespace {

double between(double low, double high, std::mt19937& random) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// `size` nodes, each a union of images of others by the same unequal scales.
DetailGraph unequal_scales(NodeId size) {
    std::mt19937 random(5);
    std::vector<double> scales;
    for (int i = 0; i < 24; ++i)
        scales.push_back(between(.1, .4, random));
    DetailGraph cut;
    for (NodeId id = 0; id < size; ++id) {
        DetailNode node;
        node.unending = true;
        node.ball = {Vec3(0.0), 1};
        for (const double scale : scales) {
            DetailEdge edge;
            edge.child = std::uniform_int_distribution<NodeId>(0, size - 1)(random);
            edge.stretch = edge.volume_stretch = scale;
            edge.similarity = true;
            edge.levels = 1;
            node.edges.push_back(edge);
        }
        cut.nodes.push_back(std::move(node));
    }
    return cut;
}

TEST(Effort, UnequalScalesAreToldApartAsFarAsTheWorkAllows) {
    const DetailGraph one = unequal_scales(1), many = unequal_scales(300);
    const PieceKind kind{0, unlimited_steps, PieceKind::step_of(1000)};
    Weights weights_of_one(one), weights_of_many(many);
    const double leaves = weights_of_one.of(kind).leaves;
    EXPECT_GT(leaves, 1e6);
    EXPECT_NEAR(weights_of_many.of(kind).leaves, leaves, .1 * leaves);
    EXPECT_LT(weights_of_many.visits(), 10'000'000u); // three times as many before
    EXPECT_GT(weights_of_many.grain(), 1);
    EXPECT_EQ(weights_of_one.grain(), 1);
}

TEST(Effort, KindsAreToldApartByTheVisitsThatTheyMayTake) {
    const DetailGraph many = unequal_scales(300);
    const PieceKind kind{0, unlimited_steps, PieceKind::step_of(1000)};
    Weights usual(many), few(many, {.most_visits = 100'000});
    const double leaves = usual.of(kind).leaves;
    EXPECT_NEAR(std::log2(few.of(kind).leaves), std::log2(leaves), 1);
    EXPECT_GT(few.grain(), usual.grain());
    EXPECT_LT(few.visits(), 1'000'000u);
    EXPECT_GT(usual.visits(), 2 * few.visits());
}

TEST(Effort, MapsThatShearAreCalibratedWithoutUnfoldingThemAll) {
    std::mt19937 random(3);
    Graph graph;
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    Object sheared{"sheared", {}, {}, {}, {}};
    const auto self = static_cast<ObjectId>(graph.objects.size());
    for (int i = 0; i < 12; ++i) { // long and thin: their volumes say little of how long they are
        const Affine map = Affine::translate({between(-1, 1, random), between(-1, 1, random), 0}) *
                           Affine::rotate({0, 0, 1}, between(-15, 15, random)) * Affine::scale({.8, .1, .1});
        sheared.instances.push_back({self, map, {}, {}, {}});
    }
    sheared.terminal = Instance{cube, {}, {}, {}, {}};
    const ObjectId master = graph.add(std::move(sheared));
    Object root{"root", {}, {}, {}, {}};
    for (int i = 0; i < 3; ++i)
        root.instances.push_back({master, Affine::translate({4.0 * i, 0, 0}), {}, {}, {}});
    graph.root = graph.add(std::move(root));
    DetailGraph cut = test::cut_of(graph);
    const Symmetry symmetry = find_symmetry(cut);
    std::uint64_t visits = 0;
    const double triangles = visible_cube_triangles(cut, symmetry, unlimited_steps, &visits);
    EXPECT_LE(visits, 400'000u); // millions before, for each of the three
    EXPECT_GT(triangles, 0);
    EXPECT_LE(triangles, 12);
}

TEST(Effort, CrowdsThatDifferInOneInstanceAreNotComparedForEver) {
    std::mt19937 random(9);
    Graph graph;
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    std::vector<Vec3> places;
    for (int i = 0; i < 2000; ++i)
        places.emplace_back(between(-1, 1, random), between(-1, 1, random), between(-1, 1, random));
    Object root{"root", {}, {}, {}, {}};
    for (int crowd = 0; crowd < 12; ++crowd) {
        Object object{"crowd" + std::to_string(crowd), {}, {}, {}, {}};
        for (const Vec3& place : places)
            object.instances.push_back(
                {ball, Affine::translate(place) * Affine::scale(Vec3(.01)), {}, {}, {}});
        // As far away as before, where no mirror takes it.
        object.instances.back().parent_from_child.translation +=
            1e-7 * Vec3(std::cos(crowd), std::sin(crowd), 0.5);
        root.instances.push_back({graph.add(std::move(object)), {}, {}, {}, {}});
    }
    graph.root = graph.add(std::move(root));
    DetailGraph cut = test::cut_of(graph);
    EXPECT_LE(find_symmetry(cut).comparisons, 10'100'000u); // each crowd with each before: 130 million
}

} // namespace
} // namespace graftal
