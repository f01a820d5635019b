// The scene that all formats read.

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/analysis/counts.h"
#include "compiler/unfolded/levels.h"
#include "compiler/unfolded/looks.h"
#include "runtime/export/mesh_groups.h"
#include "tests/unit/export/exporting.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

std::vector<SceneLeaf> leaves_of(const UnfoldedScene& scene) {
    std::vector<SceneLeaf> leaves;
    walk_leaves(scene, scene.root, {}, {}, [&](const SceneLeaf& leaf) {
        leaves.push_back(leaf);
        return leaves.size() < 200'000;
    });
    return leaves;
}

double difference(const Affine& a, const Affine& b) {
    double most = largest_entry(a.translation - b.translation);
    for (int i = 0; i < 3; ++i)
        most = std::max(most, largest_entry(a.linear[i] - b.linear[i]));
    return most;
}

/// The same leaves at the same places in the same order, in nearly the same colours.
void expect_alike(const UnfoldedScene& a, const UnfoldedScene& b, double colours) {
    const std::vector<SceneLeaf> as = leaves_of(a), bs = leaves_of(b);
    ASSERT_EQ(as.size(), bs.size());
    for (std::size_t i = 0; i < as.size(); ++i) {
        EXPECT_EQ(a.shapes[as[i].shape], b.shapes[bs[i].shape]);
        EXPECT_LT(difference(as[i].world_from_shape, bs[i].world_from_shape), 1e-12);
        const Rgb own = b.nodes[bs[i].node].look.colour();
        EXPECT_LE(largest_entry(as[i].look.colour() - own), colours) << i;
        EXPECT_EQ(as[i].look.material, b.nodes[bs[i].node].look.material) << i;
    }
}

TEST(UnfoldedScene, CountsLeavesAsStatsDoes) {
    for (const unsigned steps : {0u, 1u, 2u, 5u, 40u}) {
        Exporting exporting("m.rifs", cubes);
        exporting.options.compile.lower.steps = steps;
        for (const SceneMeshes meshes : {SceneMeshes::shared, SceneMeshes::by_size}) {
            const auto scene = exporting.scene(meshes);
            ASSERT_TRUE(scene) << exporting.said();
            const AnalysedModel& model = *exporting.viewed->model;
            EXPECT_EQ(count(*scene).leaves.str(), count_leaves(model.graph, model.components, steps))
                << steps;
        }
    }
    Exporting exporting("m.inst", shrub);
    const auto scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene) << exporting.said();
    EXPECT_EQ(count(*scene).leaves, leaves_of_shrub);
    EXPECT_EQ(scene->shapes.size(), 3u);
    EXPECT_EQ(leaves_of(*scene).size(), static_cast<std::size_t>(leaves_of_shrub));
}

TEST(UnfoldedScene, GrowsWithTheLevelsNotWithTheLeaves) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.compile.lower.steps = 60;
    const auto scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene);
    const SceneCounts counts = count(*scene);
    EXPECT_EQ(in_words(counts.leaves), "4.23e+28"); // 3^60
    EXPECT_LT(counts.nodes, 200u);
    EXPECT_LT(counts.parts, 600u);
    EXPECT_GE(counts.depth, 60u);
}

TEST(UnfoldedScene, EndsByTheSizeInThePicture) {
    std::size_t before = SIZE_MAX;
    for (const double error_px : {4.0, 8.0, 32.0}) {
        Exporting exporting("m.rifs", cubes);
        exporting.options.error_asked = true;
        exporting.options.compile.detail.error_px = error_px;
        const auto scene = exporting.scene(SceneMeshes::by_size);
        ASSERT_TRUE(scene) << exporting.said();
        const std::size_t leaves = leaves_of(*scene).size();
        EXPECT_GT(leaves, 3u);
        EXPECT_LT(leaves, before);
        before = leaves;
    }
}

TEST(UnfoldedScene, ALengthIsTheSameEverywhere) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.error_asked = true;
    exporting.options.compile.detail.error_world = 0.05;
    const auto scene = exporting.scene(SceneMeshes::by_size);
    ASSERT_TRUE(scene) << exporting.said();
    for (const SceneLeaf& leaf : leaves_of(*scene)) {
        // A terminal stands for what is no larger than that, and its parent was: the least map is a third.
        const double size = norm(leaf.world_from_shape.linear);
        EXPECT_LT(size, 0.05);
        EXPECT_GT(size, 0.05 / 3 / 8);
    }
}

TEST(UnfoldedScene, FinerMeshesForWhatIsLarger) {
    Exporting exporting("m.inst", "object m {\n sphere\n sphere scale: 1/64 translate: 2, 0, 0\n}\n");
    const auto by_size = exporting.scene(SceneMeshes::by_size), shared = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(by_size && shared);
    ASSERT_EQ(by_size->shapes.size(), 2u);
    EXPECT_NE(by_size->shapes[0].fineness, by_size->shapes[1].fineness);
    ASSERT_EQ(shared->shapes.size(), 1u);
    EXPECT_GT(shared->shapes[0].fineness, std::min(by_size->shapes[0].fineness, by_size->shapes[1].fineness));
}

TEST(UnfoldedScene, TooManyPartsAreAnError) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.compile.lower.steps = 50;
    EXPECT_FALSE(exporting.scene(SceneMeshes::shared, {.nodes = 20, .parts = 1000}));
    EXPECT_FALSE(exporting.scene(SceneMeshes::shared, {.nodes = 1000, .parts = 20}));
    EXPECT_THAT(exporting.said(), HasSubstr("too many to export"));
}

// A chain of two billion levels was unfolded three times, up to the limit of nodes, before it was refused.
TEST(UnfoldedScene, TooManyLevelsAreAnErrorBeforehand) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.compile.lower.steps = 2147483648;
    EXPECT_FALSE(exporting.scene(SceneMeshes::shared));
    EXPECT_THAT(exporting.said(), HasSubstr("this model has 2147483648 levels"));
}

TEST(UnfoldedScene, PlanesAreLeftOut) {
    Exporting exporting("m.inst", "object m {\n plane\n cube\n}\n");
    const auto scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene) << exporting.said();
    EXPECT_TRUE(scene->left_out_planes);
    EXPECT_EQ(count(*scene).leaves, 1);
}

TEST(UnfoldedScene, WhatHasNoThicknessGetsALittle) {
    Exporting exporting("m.rifs",
                        "rifs m {\n codes 2d {\n stem: 0 0 0 .16 0 0 .1\n frond: .8 .1 -.1 .8 0 1.6 .9\n }\n"
                        " terminal sphere\n}\n");
    exporting.options.compile.lower.steps = 3;
    const auto scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene) << exporting.said();
    const std::vector<SceneLeaf> leaves = leaves_of(*scene);
    EXPECT_EQ(count(*scene).leaves, leaves.size());
    // Whatever is under the stem; what falls together there is there once.
    EXPECT_GE(scene->thickened, 3u);
    EXPECT_LT(scene->thickened, leaves.size());
    for (const SceneLeaf& leaf : leaves)
        EXPECT_FALSE(is_singular(leaf.world_from_shape));
}

TEST(ExportedLooks, AreThoseOfThePaths) {
    Exporting plants("m.inst", shrub);
    Exporting maps("m.rifs", cubes);
    maps.options.compile.lower.steps = 4;
    for (Exporting* const exporting : {&plants, &maps}) {
        const auto scene = exporting->scene(SceneMeshes::shared);
        ASSERT_TRUE(scene);
        const auto resolved = resolve_looks(*scene, {}, {}, exporting->compilation.diagnostics);
        ASSERT_TRUE(resolved) << exporting->said();
        expect_alike(*scene, *resolved, 5.0 / 255);
    }
}

TEST(ExportedLooks, FewerTintsWhereFewPartsAreWanted) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.compile.lower.steps = 30;
    const auto scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene);
    const std::uint64_t parts = count(*scene).parts;
    const auto resolved = resolve_looks(*scene, {.wanted_parts = 3 * parts, .tints = TintsOn::instances}, {},
                                        exporting.compilation.diagnostics);
    ASSERT_TRUE(resolved);
    EXPECT_LE(count(*resolved).parts, 3 * parts);
    EXPECT_EQ(count(*resolved).leaves, count(*scene).leaves);
    EXPECT_THAT(exporting.said(), HasSubstr("so many tints"));
    // Whatever has no colour is coloured by one instance on the way.
    struct Step {
        SceneId node;
        bool coloured;
    };
    std::vector<std::vector<bool>> met(resolved->nodes.size(), std::vector<bool>(2));
    std::vector<Step> waiting{{resolved->root, false}};
    int colourless = 0;
    while (!waiting.empty()) {
        const Step at = waiting.back();
        waiting.pop_back();
        if (met[at.node][at.coloured]) continue;
        met[at.node][at.coloured] = true;
        const SceneNode& node = resolved->nodes[at.node];
        if (node.shape) {
            EXPECT_EQ(node.look.colourless, at.coloured);
            colourless += node.look.colourless;
        }
        for (const ScenePart& part : node.parts) {
            EXPECT_FALSE(part.colour && at.coloured);
            waiting.push_back({part.node, at.coloured || part.colour});
        }
    }
    EXPECT_GT(colourless, 0);
}

TEST(ExportedLevels, AreNoMoreThanAskedFor) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.compile.lower.steps = 7;
    const auto scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene);
    const auto resolved = resolve_looks(*scene, {}, {}, exporting.compilation.diagnostics);
    ASSERT_TRUE(resolved);
    for (const unsigned levels : {1u, 2u, 3u, 4u, 100u}) {
        const auto cut = with_levels(*resolved, levels, 1'000'000);
        ASSERT_TRUE(cut) << levels;
        EXPECT_LE(count(*cut).depth, std::max(levels, 1u)) << levels;
        const std::vector<SceneLeaf> as = leaves_of(*resolved), bs = leaves_of(*cut);
        ASSERT_EQ(as.size(), bs.size());
        for (std::size_t i = 0; i < as.size(); ++i) {
            EXPECT_EQ(as[i].node, bs[i].node);
            EXPECT_LT(difference(as[i].world_from_shape, bs[i].world_from_shape), 1e-12);
        }
    }
    EXPECT_FALSE(with_levels(*resolved, 1, 100));
}

TEST(ExportedGroups, PlaceEveryLeafOnce) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.compile.lower.steps = 6;
    const auto scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene);
    const auto resolved = resolve_looks(*scene, {}, {}, exporting.compilation.diagnostics);
    ASSERT_TRUE(resolved);
    std::size_t least_triangles = SIZE_MAX;
    for (const double most : {1.0, 5.0, 40.0, 400.0, 4000.0}) {
        const MeshGroups groups = group_meshes(*resolved, {.most_nodes = most, .triangles_of_node = 0.01});
        EXPECT_LE(groups.nodes, most);
        std::vector<Affine> placed;
        for (const MeshPlace& place : places_of(*resolved, groups)) {
            EXPECT_TRUE(groups.is_mesh[place.mesh]);
            walk_leaves(*resolved, place.mesh, place.world_from_mesh, {}, [&](const SceneLeaf& leaf) {
                placed.push_back(leaf.world_from_shape);
                return true;
            });
        }
        const std::vector<SceneLeaf> leaves = leaves_of(*resolved);
        ASSERT_EQ(placed.size(), leaves.size()) << most;
        for (std::size_t i = 0; i < placed.size(); ++i)
            EXPECT_LT(difference(placed[i], leaves[i].world_from_shape), 1e-12);
        EXPECT_LE(groups.triangles, static_cast<double>(least_triangles)); // more nodes, no larger meshes
        least_triangles = static_cast<std::size_t>(groups.triangles);
    }
}

TEST(ExportedCounts, AreReadable) {
    EXPECT_EQ(in_words(BigCount(0)), "0");
    EXPECT_EQ(in_words(BigCount("999999999999999")), "999999999999999");
    EXPECT_EQ(in_words(BigCount("1234567890123456")), "1.23e+15");
}

} // namespace
} // namespace graftal
