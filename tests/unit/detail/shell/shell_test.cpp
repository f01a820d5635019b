// Shells of sets whose copies lie in each other (compiler/detail/shell/shell.h).

#include "compiler/detail/shell/shell.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/detail/prepare.h"
#include "compiler/detail/shadow/coverage.h"
#include "compiler/detail/weights.h"
#include "tests/unit/detail/models.h"

namespace graftal {
namespace {

/// Maps x -> share (x + corner) over the corners of the square or cube; beyond 1/2 the copies lie in each
/// other.
Graph corners_graph(int dimensions, double share, int copies = 1) {
    Graph graph;
    Object set{"corners", {}, {}, {}, {}};
    for (int copy = 0; copy < copies; ++copy)
        for (int j = 0; j < 1 << dimensions; ++j) {
            Vec3 corner(j & 1 ? 1 : -1, j & 2 ? 1 : -1, j & 4 ? 1 : -1);
            if (dimensions == 2) corner.z = 0;
            // Copies that differ by less than anybody sees, but differ.
            set.instances.push_back({0, {Mat3(share), (1 - share) * (1 + 1e-4 * copy) * corner}, {}, {}, {}});
        }
    graph.root = graph.add(std::move(set));
    return graph;
}

PreparedGraph prepared(const Graph& graph, const DetailOptions& options = {}) {
    return prepare_graph(graph, strong_components(graph), test::bounds_of(graph), options.preparing());
}

double detail_for(const DetailGraph& cut, double cells_across) {
    return cells_across / (2 * cut.nodes[cut.root].ball.radius);
}

TEST(Shell, PointsAreTrueAndNoTruePointOutsideIsFar) {
    const PreparedGraph ready = prepared(corners_graph(3, 0.7));
    const DetailGraph& cut = ready.cut;
    const auto set = point_set(cut, cut.root, unlimited_steps, detail_for(cut, 120), {});
    ASSERT_FALSE(set.points.empty());
    EXPECT_FALSE(set.flat);
    std::set<std::array<int, 3>> cells;
    for (const auto& p : set.points) {
        std::array<int, 3> cell{};
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LE(std::abs(p[k] + static_cast<float>(set.middle[static_cast<int>(k)])), 1 + 1e-5)
                << "not in the cube, which the set is";
            cell[k] = static_cast<int>(std::floor(static_cast<double>(p[k]) / set.cell));
        }
        EXPECT_TRUE(cells.insert(cell).second) << "two points in one cell";
    }
    // The set is the cube: random points of its sides.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> side(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        Vec3 p(side(random), side(random), side(random));
        p[i % 3] = i % 2 ? 1 : -1;
        bool near = false;
        const Vec3 q = (p - set.middle) / set.cell;
        for (int dx = -3; dx <= 3 && !near; ++dx)
            for (int dy = -3; dy <= 3 && !near; ++dy)
                for (int dz = -3; dz <= 3 && !near; ++dz)
                    near = cells.contains({static_cast<int>(std::floor(q.x)) + dx,
                                           static_cast<int>(std::floor(q.y)) + dy,
                                           static_cast<int>(std::floor(q.z)) + dz});
        EXPECT_TRUE(near) << p.x << " " << p.y << " " << p.z;
    }
}

TEST(Shell, WhatNobodySeesIsLeftOut) {
    const PreparedGraph ready = prepared(corners_graph(3, 0.7));
    const DetailGraph& cut = ready.cut;
    const auto set = point_set(cut, cut.root, unlimited_steps, detail_for(cut, 200), {});
    ASSERT_FALSE(set.points.empty());
    const double side_cells = 2 / set.cell;
    EXPECT_LT(static_cast<double>(set.points.size()), 0.5 * side_cells * side_cells * side_cells);
    EXPECT_TRUE(set.is_inside({0, 0, 0}));
}

TEST(Shell, WorkGrowsWithCellsAndNotWithCopies) {
    for (const double share : {0.6, 0.8, 0.9}) {
        const PreparedGraph ready = prepared(corners_graph(2, share));
        const DetailGraph& cut = ready.cut;
        const auto set = point_set(cut, cut.root, unlimited_steps, detail_for(cut, 300), {});
        ASSERT_FALSE(set.points.empty());
        EXPECT_TRUE(set.flat);
        // Four maps move each point of the last grid once; those before are sixth parts of it and of each
        // other, or less, except the first.
        EXPECT_LT(set.work, 3 * 4 * set.points.size()) << share;
        const double side_cells = 2 / set.cell;
        EXPECT_GT(static_cast<double>(set.points.size()), 0.9 * side_cells * side_cells) << share;
    }
}

TEST(Shell, LimitsMakeItCoarserAndNotLess) {
    const PreparedGraph ready = prepared(corners_graph(2, 0.8));
    const DetailGraph& cut = ready.cut;
    PointLimits limits;
    limits.points = 20'000;
    const auto set = point_set(cut, cut.root, unlimited_steps, detail_for(cut, 2000), limits);
    ASSERT_FALSE(set.points.empty());
    EXPECT_LE(set.points.size(), limits.points);
    EXPECT_GT(set.points.size(), limits.points / 8);
    EXPECT_GT(set.cell * detail_for(cut, 2000), 5);
}

/// Where a first look took too much there was nothing, and then a shell without a limit.
TEST(Shell, LittleWorkMakesItCoarserAndNotNothing) {
    const PreparedGraph ready = prepared(corners_graph(3, 0.9));
    const DetailGraph& cut = ready.cut;
    for (const std::uint64_t work : {1'000'000ull, 100'000ull, 20'000ull}) {
        PointLimits limits;
        limits.work = work;
        const PointSet set = point_set(cut, cut.root, unlimited_steps, detail_for(cut, 2000), limits);
        EXPECT_FALSE(set.points.empty()) << work;
        EXPECT_LE(set.work, work + work / 10) << work;
        EXPECT_GT(set.cell * detail_for(cut, 2000), 5) << work;
    }
}

TEST(Shell, WhatLeadsToAPrimitiveIsSolid) {
    Graph graph;
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    const auto dust = static_cast<ObjectId>(graph.objects.size());
    graph.objects.push_back({"dust", {}, {}, {}, {}});
    for (const double x : {-1.0, 1.0})
        graph.objects[dust].instances.push_back({dust, {Mat3(0.4), Vec3(x, 0, 0)}, {}, {}, {}});
    Object top{"top", {}, {}, {}, {}};
    top.instances.push_back({dust, {}, {}, {}, {}});
    top.instances.push_back({ball, Affine::scale(Vec3(0.1)), {}, {}, {}});
    graph.root = graph.add(std::move(top));
    const PreparedGraph ready = prepared(graph);
    EXPECT_TRUE(ready.cut.nodes[ready.cut.root].solid);
    const auto found = std::ranges::find(ready.cut.nodes, "dust", &DetailNode::name);
    ASSERT_NE(found, ready.cut.nodes.end());
    EXPECT_FALSE(found->solid);
}

TEST(Shell, IsAClosedSurface) {
    const PreparedGraph ready = prepared(corners_graph(3, 0.65));
    const DetailGraph& cut = ready.cut;
    ShellRequest request;
    request.node = cut.root;
    request.detail_per_unit = detail_for(cut, 60);
    request.inherited = {Rgb(0.5)};
    const Baked baked = bake_shell(cut, request, 10'000'000);
    ASSERT_TRUE(baked.complete);
    ASSERT_EQ(baked.parts.size(), 1u);
    const Mesh& mesh = baked.parts.front().mesh;
    EXPECT_EQ(mesh.triangles.size(), baked.triangles);
    // Each edge is passed as often in one direction as in the other.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> passed;
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
            passed[std::minmax(from, to)] += from < to ? 1 : -1;
        volume += glm::dot(mesh.vertices[a], glm::cross(mesh.vertices[b], mesh.vertices[c])) / 6;
    }
    for (const auto& [edge, balance] : passed)
        ASSERT_EQ(balance, 0);
    // The cube's, and no more than a cell or so around it.
    const double unit = baked.representative_from_body.linear[0][0];
    EXPECT_NEAR(std::cbrt(volume) * unit, 2, 3 / request.detail_per_unit);
}

/// Dust has a dozen times as many triangles a point as a surface: there was nothing, after all the work.
TEST(Shell, TooManyTrianglesMakeItCoarserAndNotNothing) {
    for (const double share : {0.2, 0.35, 0.45}) {
        const PreparedGraph ready = prepared(corners_graph(3, share));
        const DetailGraph& cut = ready.cut;
        ShellRequest request;
        request.node = cut.root;
        request.detail_per_unit = detail_for(cut, 1000);
        request.inherited = {Rgb(0.5)};
        for (const std::size_t most : {100'000u, 10'000u}) {
            const Baked baked = bake_shell(cut, request, most);
            ASSERT_TRUE(baked.complete) << share << " " << most;
            EXPECT_LE(baked.triangles, most) << share;
            EXPECT_GT(baked.triangles, most / 64) << share;
            EXPECT_GT(baked.culled_detail, 2) << share << ": the error is told";
            EXPECT_GT(baked.shell_work, baked.triangles) << share << ": the surface is work, too";
        }
    }
}

TEST(Shell, CrowdsAreToldFromSetsThatOnlyFillSpace) {
    const struct {
        int dimensions;
        double share;
        bool crowded;
    } cases[] = {{2, 0.5, false}, {3, 0.5, false}, {2, 0.45, false}, {2, 0.75, true}, {3, 0.7, true}};
    for (const auto& c : cases) {
        const PreparedGraph ready = prepared(corners_graph(c.dimensions, c.share));
        Weights weights(ready.cut);
        const double unit = detail_for(ready.cut, 500);
        EXPECT_EQ(weights.of({ready.cut.root, unlimited_steps, PieceKind::step_of(unit)}).crowded, c.crowded)
            << c.dimensions << " dimensions, " << c.share;
        EXPECT_EQ(weights.shell_sizes(ready.cut.root, unlimited_steps).any(), c.crowded);
    }
}

/// A wood in which every bush is a crowd from afar is none itself: it was drawn as one lump.
TEST(Shell, ACrowdSomewhereInsideMakesNoneOfTheWhole) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> side(-1, 1);
    Graph graph;
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    Object bush{"bush", {}, {}, {}, {}}, wood{"wood", {}, {}, {}, {}};
    for (int i = 0; i < 300; ++i)
        bush.instances.push_back(
            {ball, {Mat3(0.02), Vec3(side(random), side(random), side(random))}, {}, {}, {}});
    const ObjectId master = graph.add(std::move(bush));
    for (int i = 0; i < 2000; ++i)
        wood.instances.push_back(
            {master, Affine::translate(1000.0 * Vec3(side(random), 0, side(random))), {}, {}, {}});
    graph.root = graph.add(std::move(wood));
    const PreparedGraph ready = prepared(graph);
    Weights weights(ready.cut);
    const PieceKind near{ready.cut.root, unlimited_steps, PieceKind::step_of(detail_for(ready.cut, 1000))};
    EXPECT_TRUE(weights.of(near).crowded) << "its bushes are";
    EXPECT_FALSE(weights.is_shell(near));
    const ShellSizes sizes = weights.shell_sizes(ready.cut.root, unlimited_steps);
    EXPECT_TRUE(sizes.has(3)) << "its bushes lie in each other";
    EXPECT_FALSE(sizes.has(1000));
    EXPECT_FALSE(sizes.has(1e9));
}

void expect_what_is_made_anew(ShellStore& store, const DetailGraph& cut, double cells_across,
                              const PointLimits& limits) {
    const double detail = detail_for(cut, cells_across);
    const auto kept = store.points(cut, cut.root, unlimited_steps, detail, limits);
    const auto anew = point_set(cut, cut.root, unlimited_steps, detail, limits);
    ASSERT_FALSE(anew.points.empty());
    EXPECT_EQ(kept->points, anew.points);
    EXPECT_EQ(kept->cell, anew.cell);
    EXPECT_EQ(kept->work, anew.work);
}

TEST(ShellStore, GivesWhatIsMadeAnewAndMakesItOnce) {
    const PreparedGraph ready = prepared(corners_graph(3, 0.65));
    const DetailGraph& cut = ready.cut;
    ShellStore store;
    const PointLimits limits;
    for (const double across : {60.0, 20.0, 60.0, 20.0})
        ASSERT_NO_FATAL_FAILURE(expect_what_is_made_anew(store, cut, across, limits));
    EXPECT_EQ(store.made(), 2u);
}

/// A native picture that is tried at ten errors asked ten times for one shell that is as fine as it may be.
TEST(ShellStore, OneGridServesAllThatAskForAFinerOneThanTheLimitsAllow) {
    const PreparedGraph ready = prepared(corners_graph(2, 0.8));
    const DetailGraph& cut = ready.cut;
    ShellStore store;
    PointLimits limits;
    limits.points = 20'000;
    for (const double across : {1e7, 4e6, 2000.0, 1e9})
        ASSERT_NO_FATAL_FAILURE(expect_what_is_made_anew(store, cut, across, limits));
    EXPECT_EQ(store.made(), 1u);
    const auto coarse = store.points(cut, cut.root, unlimited_steps, detail_for(cut, 40), limits);
    ASSERT_TRUE(coarse);
    EXPECT_NEAR(coarse->cell, 1 / detail_for(cut, 40), 1e-12);
    EXPECT_EQ(store.made(), 2u);
}

TEST(ShellStore, KeepsTheLastThatItHasRoomFor) {
    const PreparedGraph ready = prepared(corners_graph(3, 0.65));
    const DetailGraph& cut = ready.cut;
    ShellStore none(0);
    for (int i = 0; i < 2; ++i)
        ASSERT_FALSE(none.points(cut, cut.root, unlimited_steps, detail_for(cut, 20), {})->points.empty());
    EXPECT_EQ(none.made(), 2u);
}

TEST(Shell, TintsAndMaterialsAreTheLeaves) {
    Graph graph;
    graph.materials.resize(1);
    graph.materials[0].name = "green";
    graph.materials[0].rgb = Rgb(0.2, 0.4, 0.1);
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    Object set{"set", {}, {}, {}, {}};
    const auto self = static_cast<ObjectId>(graph.objects.size());
    set.instances.push_back({cube, Affine::scale(Vec3(0.2)), Tint{Rgb(1, 0, 0), 0.5}, MaterialId{0}, {}});
    for (int j = 0; j < 8; ++j)
        set.instances.push_back(
            {self, {Mat3(0.7), 0.3 * Vec3(j & 1 ? 1 : -1, j & 2 ? 1 : -1, j & 4 ? 1 : -1)}, {}, {}, {}});
    graph.root = graph.add(std::move(set));
    const PreparedGraph ready = prepared(graph);
    ShellRequest request;
    request.node = ready.cut.root;
    request.detail_per_unit = detail_for(ready.cut, 40);
    request.inherited = {Rgb(0.0), Rgb(1.0)};
    const Baked baked = bake_shell(ready.cut, request, 10'000'000);
    ASSERT_TRUE(baked.complete);
    for (const BakedPart& part : baked.parts) {
        EXPECT_EQ(part.material, MaterialId{0});
        for (const Palette& palette : part.palettes)
            for (const Rgb& rgb : palette) {
                EXPECT_NEAR(rgb.r, 0.6, 1.0 / 255);
                EXPECT_NEAR(rgb.g, 0.2, 1.0 / 255);
                EXPECT_NEAR(rgb.b, 0.05, 1.0 / 255);
            }
    }
}

} // namespace
} // namespace graftal
