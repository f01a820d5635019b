#include "compiler/povray/cut/cut.h"

#include <algorithm>
#include <array>
#include <map>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/graph/unfold.h"
#include "tests/unit/detail/models.h"
#include "tests/unit/povray/cut/cut_graph.h"

namespace graftal {
namespace {

View front_view(double angle_deg = 40, double distance = 4) {
    View view;
    view.size = {640, 480};
    view.camera.location = Vec3(0, 0, distance);
    view.camera.angle_deg = angle_deg;
    return view;
}

std::optional<Cut> cut(const Graph& graph, const DetailOptions& options, Diagnostics& diagnostics,
                       const View& view = front_view(), bool flatten = false) {
    return test::cut_graph(graph, strong_components(graph), test::bounds_of(graph), view, options,
                           diagnostics, {.flatten = flatten});
}

Cut must_cut(const Graph& graph, const DetailOptions& options, const View& view = front_view(),
             bool flatten = false) {
    Diagnostics diagnostics;
    std::optional<Cut> result = cut(graph, options, diagnostics, view, flatten);
    EXPECT_TRUE(result.has_value()) << diagnostics.render(SourceMap());
    return result ? std::move(*result) : Cut();
}

using DrawnTriangle = std::array<long long, 6>;

DrawnTriangle drawn(Vec3 centroid, Rgb rgb) {
    const auto digit = [](double x, double unit) { return std::llround(x / unit); };
    return {digit(centroid.x, 1e-7), digit(centroid.y, 1e-7), digit(centroid.z, 1e-7),
            digit(rgb.r, 1e-6),      digit(rgb.g, 1e-6),      digit(rgb.b, 1e-6)};
}

/// Centroid and colour of all that a cut of triangles and cubes draws; a cube counts as its centre.
std::map<DrawnTriangle, int> all_drawn(const Cut& cut) {
    std::map<DrawnTriangle, int> result;
    for (const PlacementGroup& group : cut.groups) {
        const Palette& palette = cut.palettes[group.palette];
        for (const Placement& placement : group.placements) {
            const Body& body = cut.bodies[placement.body];
            if (std::holds_alternative<Primitive>(body.shape)) {
                ++result[drawn(placement.world_from_body.translation, group.tint.over(palette[0]))];
                continue;
            }
            const Mesh& mesh = std::get<Mesh>(body.shape);
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
                Vec3 centroid(0.0);
                for (const auto corner : mesh.triangles[t])
                    centroid += mesh.vertices[corner] / 3.0;
                const std::size_t slot = palette.size() > 1 ? mesh.slot_of_triangle[t] : 0;
                ++result[drawn(placement.world_from_body(centroid), group.tint.over(palette[slot]))];
            }
        }
    }
    return result;
}

TEST(Cut, TwoLevelsDrawWhatTheAbsoluteSpecificationDraws) {
    const Graph graph = test::gasket(false);
    for (unsigned steps = 0; steps <= 6; ++steps) {
        const DetailOptions options{.error_px = 0, .steps = steps};
        const Cut two_level = must_cut(graph, options);
        const Cut flat = must_cut(graph, options, front_view(), true);
        EXPECT_EQ(flat.placement_count, std::llround(std::pow(3, steps)));
        EXPECT_EQ(all_drawn(two_level), all_drawn(flat)) << steps;
        EXPECT_EQ(flat.error_px, 0);
    }
}

TEST(Cut, WhatStandsBesideAPlaneWeighsAsMuchAsAlone) {
    Graph graph = test::pound_sign(3, false);
    const double alone = must_cut(graph, {}).leaf_count;
    ASSERT_GT(alone, 1e10);
    Object beside{"beside", {}, {}, {}, {}};
    beside.instances.push_back({graph.root, {}, {}, {}, {}});
    const Affine lower{Mat3(1.0), Vec3(0, -2, 0)};
    beside.instances.push_back({graph.primitive(PrimitiveKind::plane), lower, {}, {}, {}});
    graph.root = graph.add(std::move(beside));
    EXPECT_NEAR(must_cut(graph, {}).leaf_count, alone, 0.01 * alone);
}

TEST(Cut, TintsDoNotDependOnWhereThePathIsSplit) {
    // Flat cubes do not touch edge to edge in this model until depth 2, and tinted triangles never merge.
    Graph graph = test::pound_sign(3, true);
    const ObjectId triangle = graph.primitive(PrimitiveKind::triangle);
    for (Object& object : graph.objects)
        if (object.terminal) object.terminal->master = triangle;
    for (unsigned steps = 1; steps <= 4; ++steps) {
        const DetailOptions options{.error_px = 0, .steps = steps};
        const auto two_level = all_drawn(must_cut(graph, options));
        const auto flat = all_drawn(must_cut(graph, options, front_view(), true));
        EXPECT_EQ(two_level.size(), flat.size()) << steps;
        EXPECT_EQ(two_level, flat) << steps;
    }
}

TEST(Cut, MirrorImagesShareOneMesh) {
    const Cut result = must_cut(test::pound_sign(3, true), {.error_px = 0, .steps = 6});
    int meshes = 0;
    for (const Body& body : result.bodies)
        meshes += std::holds_alternative<Mesh>(body.shape);
    EXPECT_EQ(meshes, 1);
    EXPECT_EQ(result.leaf_count, 8 * std::pow(7, 5));
}

TEST(Cut, MirrorImagesShareOneMeshWhateverTheirBalls) {
    const Graph graph = test::pound_sign(3, false);
    std::vector<ObjectBounds> bounds = test::bounds_of(graph);
    for (std::size_t id = 0; id < bounds.size(); ++id)
        bounds[id].ball.radius *= 1 + 0.01 * static_cast<double>(id);
    for (const double error_px : {0.0, 2.0}) {
        Diagnostics diagnostics;
        const std::optional<Cut> result =
            test::cut_graph(graph, strong_components(graph), bounds, front_view(),
                            {.error_px = error_px, .steps = 7}, diagnostics);
        ASSERT_TRUE(result);
        EXPECT_EQ(result->bodies.size(), 1u);
    }
}

TEST(Cut, CurvedLeavesAreSpeltOutWhereTheyAreFew) {
    Graph graph = test::gasket(false);
    const ObjectId cylinder = graph.primitive(PrimitiveKind::cylinder);
    for (Object& object : graph.objects)
        if (object.terminal) object.terminal->master = cylinder;
    EXPECT_EQ(must_cut(graph, {.error_px = 0, .steps = 6}).placement_count, 729u);
    const Cut many = must_cut(graph, {.error_px = 0, .steps = 15});
    EXPECT_LT(many.placement_count, 100'000u);
    EXPECT_GT(many.triangle_count, 0u);
    EXPECT_EQ(many.leaf_count, std::pow(3, 15));
}

/// Unions of two of the next: 2^length cubes.
Graph doubling_chain(int length) {
    Graph graph;
    ObjectId below = graph.primitive(PrimitiveKind::cube);
    for (int i = 0; i < length; ++i) {
        Object object;
        object.name = "b" + std::to_string(i);
        for (const double side : {-1.0, 1.0}) {
            Instance instance;
            instance.master = below;
            instance.parent_from_child = Affine::translate(Vec3(side, 0, 0)) *
                                         Affine::rotate(Vec3(0, 1, 0), 20 * side) * Affine::scale(Vec3(0.45));
            object.instances.push_back(instance);
        }
        below = graph.add(std::move(object));
    }
    graph.root = below;
    return graph;
}

TEST(Cut, DeepUnionsAreRefusedOrCulledWithoutUnfoldingThem) {
    for (const int length : {60, 500, 3000}) {
        const Graph graph = doubling_chain(length);
        Diagnostics diagnostics;
        EXPECT_FALSE(cut(graph, {.error_px = 0}, diagnostics)) << length;
        EXPECT_EQ(diagnostics.error_count(), 1u);
        EXPECT_LE(must_cut(graph, {.error_px = 2}).error_px, 2) << length;
    }
}

TEST(Cut, HiddenFacesBetweenCubesAreNotDrawn) {
    const Cut result = must_cut(test::pound_sign(3, false), {.error_px = 0, .steps = 6});
    const double leaves_a_mesh = result.leaf_count / static_cast<double>(result.placement_count);
    EXPECT_LT(static_cast<double>(result.triangle_count), 0.5 * 12 * leaves_a_mesh);
}

TEST(Cut, MemoryFollowsTheSquareRootOfTheLeaves) {
    const Graph graph = test::gasket(false);
    const Cut small = must_cut(graph, {.error_px = 0, .steps = 10});
    const Cut large = must_cut(graph, {.error_px = 0, .steps = 20});
    const double growth = static_cast<double>(large.placement_count + large.triangle_count) /
                          static_cast<double>(small.placement_count + small.triangle_count);
    EXPECT_NEAR(std::log(growth) / std::log(3), 5, 1);
}

TEST(Cut, ErrorBoundsWhatIsLeft) {
    for (const double error_px : {8.0, 2.0, 0.5}) {
        const Cut result = must_cut(test::gasket(false), {.error_px = error_px});
        EXPECT_LE(result.error_px, error_px);
        EXPECT_GT(result.error_px, 0.2 * error_px);
    }
}

TEST(Cut, ASmallBudgetGivesACoarserPictureAndSaysSo) {
    Diagnostics diagnostics;
    const std::optional<Cut> result =
        cut(test::pound_sign(3, false), {.error_px = 0.1, .memory_bytes = 40'000'000}, diagnostics);
    ASSERT_TRUE(result.has_value());
    EXPECT_GT(result->error_px, 0.1);
    EXPECT_LE(result->estimated_bytes, 40'000'000u);
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_EQ(diagnostics.all()[0].severity, Severity::warning);
    EXPECT_NE(diagnostics.all()[0].message.find("memory allow an error of"), std::string::npos);
}

TEST(Cut, ThatASetWithoutAreaIsDrawnWiderThanItIsIsNoted) {
    const auto noted = [](Graph graph, bool terminal, double error_px) {
        if (!terminal)
            for (Object& object : graph.objects)
                object.terminal.reset();
        DetailOptions options;
        options.error_px = error_px;
        options.steps = error_px > 0 ? std::optional<unsigned>() : 4;
        Diagnostics diagnostics;
        EXPECT_TRUE(cut(graph, options, diagnostics).has_value());
        EXPECT_FALSE(diagnostics.has_errors());
        EXPECT_EQ(diagnostics.render(SourceMap(), true), "") << "quiet";
        EXPECT_LE(diagnostics.all().size(), 1u);
        if (diagnostics.all().empty()) return std::string();
        const Diagnostic& note = diagnostics.all().front();
        EXPECT_EQ(note.severity, Severity::note);
        EXPECT_NE(note.message.find("one pixel wide"), std::string::npos) << note.message;
        return note.hint;
    };
    // The hint says how to draw it larger.
    EXPECT_NE(noted(test::gasket(true), false, 4).find("'terminal sphere below 4'"), std::string::npos);
    EXPECT_NE(noted(test::gasket(false), false, 4).find("'terminal sphere below 4'"), std::string::npos)
        << "flat";
    EXPECT_EQ(noted(test::gasket(true), false, 0), "") << "nothing is culled";
    EXPECT_EQ(noted(test::gasket(true), true, 4), "");
    EXPECT_EQ(noted(test::pound_sign(3, false), false, 4), "") << "of dimension 2.8";
}

TEST(Cut, WithoutCullingABudgetThatCannotBeKeptIsRefused) {
    Diagnostics diagnostics;
    EXPECT_FALSE(cut(test::pound_sign(3, false), {.error_px = 0, .steps = 40}, diagnostics).has_value());
    ASSERT_EQ(diagnostics.error_count(), 1u);
    EXPECT_NE(diagnostics.all()[0].message.find("primitives need about"), std::string::npos);
}

TEST(Cut, FlatteningIsRefusedBeforeItStarts) {
    Diagnostics diagnostics;
    const DetailOptions options{.error_px = 0, .steps = 100};
    EXPECT_FALSE(cut(test::gasket(false), options, diagnostics, front_view(), true).has_value());
    EXPECT_EQ(diagnostics.error_count(), 1u);
}

TEST(Cut, RecursionWithoutAnEndIsRefused) {
    Diagnostics diagnostics;
    EXPECT_FALSE(cut(test::gasket(false), {.error_px = 0}, diagnostics).has_value());
    ASSERT_EQ(diagnostics.error_count(), 1u);
    EXPECT_EQ(diagnostics.all()[0].message, "the recursion has no end, and no option limits its depth");
}

TEST(Cut, AnEyeOnTheModelStillEnds) {
    View view = front_view();
    view.camera.location = Vec3(0, 1, 0);
    const Cut result = must_cut(test::gasket(false), {.error_px = 2}, view);
    EXPECT_GT(result.placement_count, 0u);
}

TEST(Cut, SingularMapsAreDrawnWithAThickness) {
    // A fern's stem: a map onto a line.
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Object plant{"plant", {}, {}, {}, {}};
    Affine stem;
    stem.linear = Mat3(0.0);
    stem.linear[1][1] = 0.3;
    plant.instances.push_back({1, stem, {}, {}, {}});
    plant.instances.push_back({1, {Mat3(0.7), Vec3(0, 0.3, 0)}, {}, {}, {}});
    plant.terminal = Instance{sphere, {}, {}, {}, {}};
    graph.root = graph.add(std::move(plant));
    for (const DetailOptions& options :
         {DetailOptions{.error_px = 0.5}, DetailOptions{.error_px = 0, .steps = 5}}) {
        const Cut result = must_cut(graph, options);
        for (const PlacementGroup& group : result.groups)
            for (const Placement& placement : group.placements)
                EXPECT_FALSE(is_singular(placement.world_from_body, 1e-8));
        EXPECT_GT(result.triangle_count, 0u);
    }
}

TEST(Cut, CoincidentPartsAreDrawnOnce) {
    Graph graph;
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    Object pile{"pile", {}, {}, {}, {}};
    for (int i = 0; i < 50'000; ++i)
        pile.instances.push_back({cube, {}, {}, {}, {}});
    graph.root = graph.add(std::move(pile));
    const Cut result = must_cut(graph, {.error_px = 0});
    EXPECT_LE(result.placement_count + result.triangle_count, 13u);
}

TEST(Cut, ChainsOfAHundredThousandObjectsAreNoProblem) {
    Graph graph;
    ObjectId last = graph.primitive(PrimitiveKind::cube);
    for (int i = 0; i < 100'000; ++i) {
        Object link{"link" + std::to_string(i), {}, {}, {}, {}};
        link.instances.push_back({last, Affine::translate(Vec3(1e-5, 0, 0)), {}, {}, {}});
        if (i % 1000 == 0) link.instances.push_back({0, Affine::scale(Vec3(0.1)), {}, {}, {}});
        last = graph.add(std::move(link));
    }
    graph.root = last;
    std::vector<ObjectBounds> bounds(graph.objects.size());
    for (ObjectBounds& b : bounds)
        b = {{Vec3(-2), Vec3(2)}, {Vec3(0), 3.5}, false};
    Diagnostics diagnostics;
    const auto result =
        test::cut_graph(graph, strong_components(graph), bounds, front_view(), {}, diagnostics);
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->leaf_count, 101);
}

} // namespace
} // namespace graftal
