// Where memory ends, what was done counts as work nevertheless: else a cut tries for ever.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <variant>

#include <gtest/gtest.h>

#include "compiler/detail/bake.h"
#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/shell/store.h"
#include "compiler/detail/weights.h"
#include "compiler/povray/costs.h"
#include "compiler/povray/cut/assemble.h"
#include "runtime/system/memory_limit.h"
#include "tests/unit/detail/models.h"

namespace graftal {
namespace {

constexpr std::uint64_t memory_bytes = 256u << 20;

/// A ball at each of 16^levels places.
Graph balls(int levels = 6) {
    Graph graph;
    ObjectId whole = graph.primitive(PrimitiveKind::sphere);
    for (int level = 0; level < levels; ++level) {
        Object object{"level" + std::to_string(level), {}, {}, {}, {}};
        for (int i = 0; i < 16; ++i)
            object.instances.push_back(
                {whole,
                 Affine::translate({i % 4 - 1.5, i / 4 - 1.5, 0.1 * i}) * Affine::scale(Vec3(0.2)),
                 {},
                 {},
                 {}});
        whole = graph.add(std::move(object));
    }
    graph.root = whole;
    return graph;
}

struct Model {
    Graph graph = balls();
    DetailGraph cut = test::cut_of(graph);
    Symmetry symmetry = find_symmetry(cut);
};

Baked baked(const Model& model, BakeRequest request = {}) {
    request.representative = model.cut.root;
    request.detail_per_unit = INFINITY;
    request.painters = {{model.symmetry.pair[model.cut.root], Rgb(0.5)}};
    return bake(model.cut, model.symmetry, request, SIZE_MAX / 8);
}

TEST(OutOfMemory, VisitsOfABakeAreKept) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "sanitizers end a program whose memory ends";
#endif
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto bake_within = [] {
        const Model model;
        limit_memory(memory_bytes);
        const Baked stopped = baked(model);
        const bool good = !stopped.complete && stopped.visits > 1000 && stopped.parts.empty();
        std::_Exit(good ? 0 : 1);
    };
    EXPECT_EXIT(bake_within(), testing::ExitedWithCode(0), "");
}

/// A mesh that is given up has cost what was made of it.
TEST(BakeGivenUp, CountsTheTrianglesThatItMade) {
    Graph graph;
    Object object{"row", {}, {}, {}, {}};
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    for (int i = 0; i < 1000; ++i)
        object.instances.push_back({cube, Affine::translate({3.0 * i, 0, 0}), {}, {}, {}});
    graph.root = graph.add(std::move(object));
    Model model;
    model.graph = graph;
    model.cut = test::cut_of(model.graph);
    model.symmetry = find_symmetry(model.cut);
    EXPECT_EQ(baked(model).made_triangles, 12000u);
    BakeRequest request;
    request.most_made_triangles = 6000;
    const Baked stopped = baked(model, request);
    EXPECT_FALSE(stopped.complete);
    EXPECT_TRUE(stopped.parts.empty());
    EXPECT_GT(stopped.made_triangles, 6000u);
    EXPECT_LT(stopped.made_triangles, 6100u);
}

/// The model as one mesh, or with a threshold of 0 as many placements as there are balls.
std::optional<Cut> assembled(const Model& model, double threshold, AssemblyLimits& limits) {
    View view;
    view.size = {64, 48};
    view.camera.location = {0, 0, -10};
    DetailOptions options;
    options.error_px = 0;
    const Projection projection(view, options, 0, 1e-3);
    Weights weights(model.cut);
    Piece root;
    root.node = model.cut.root;
    Choice choice;
    choice.threshold = threshold;
    choice.spelt_out = threshold == 0;
    ShellStore shells;
    return assemble(model.cut, model.symmetry, projection, root, choice, weights, false, shells, limits);
}

TEST(OutOfMemory, WorkOfAnAssemblyIsTakenOff) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "sanitizers end a program whose memory ends";
#endif
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto assemble_within = [](double threshold) {
        const Model model;
        AssemblyLimits limits{1e18, 1000, 1};
        limit_memory(memory_bytes);
        const bool complete = assembled(model, threshold, limits).has_value();
        std::_Exit(!complete && limits.work_seconds < 999.99 ? 0 : 1);
    };
    for (const double threshold : {0.0, 1e300})
        EXPECT_EXIT(assemble_within(threshold), testing::ExitedWithCode(0), "") << threshold;
}

/// Triangles alone were counted before: corners and normals took a compiler beyond the memory allowed.
TEST(MemoryOfAnAssembly, CountsCornersOfMeshes) {
    Model model;
    model.graph = balls(2);
    model.cut = test::cut_of(model.graph);
    model.symmetry = find_symmetry(model.cut);
    AssemblyLimits limits{1e18, 1000, 1};
    const std::optional<Cut> cut = assembled(model, 1e300, limits);
    ASSERT_TRUE(cut);
    double triangles = 0, whole = 0;
    for (const Body& body : cut->bodies)
        if (const Mesh* mesh = std::get_if<Mesh>(&body.shape)) {
            triangles += PovrayCosts::triangle * static_cast<double>(mesh->triangles.size());
            whole += povray_bytes(*mesh);
        }
    ASSERT_GT(whole, triangles);
    const double all = povray_bytes(*cut);
    AssemblyLimits enough{all, 1000, 1}, too_little{all - 0.5 * (whole - triangles), 1000, 1};
    EXPECT_TRUE(assembled(model, 1e300, enough));
    EXPECT_FALSE(assembled(model, 1e300, too_little));
}

} // namespace
} // namespace graftal
