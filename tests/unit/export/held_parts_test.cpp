// Parts that stay meshes of their own: each leaf keeps its place and look, and each named part is one mesh
// wherever it is.

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/unfolded/looks.h"
#include "runtime/export/held_parts.h"
#include "runtime/export/mesh_groups.h"
#include "tests/unit/export/exporting.h"

namespace graftal {
namespace {

using testing::HasSubstr;

constexpr const char* tree = R"(
canonical object leaf { sphere scale: 0.3, 0.02, 0.2 tint: 0.2, 0.6, 0.1, 0.5 }
canonical object twig {
  cylinder scale: 0.05, 1, 0.05
  leaf translate: 0.2, 1
  leaf rotate: y 90 translate: 0, 0.7
}
object tree {
  cylinder scale: 0.1, 2, 0.1
  twig translate: 0, 2
  twig rotate: z 40 translate: 0, 1
  leaf translate: 0, 3
}
)";

/// Each object places some of those before it.
std::string random_graph(std::mt19937& random, int objects) {
    const auto number = [&] { return std::uniform_real_distribution<double>(-2, 2)(random); };
    std::string text;
    for (int i = 0; i < objects; ++i) {
        text += fmt::format("{}object o{} {{\n", i + 1 == objects ? "" : "canonical ", i);
        const int parts = 1 + static_cast<int>(random() % 3);
        for (int part = 0; part < parts; ++part) {
            const std::string what = i == 0 || random() % 3 == 0
                                         ? "cube"
                                         : fmt::format("o{}", random() % static_cast<unsigned>(i));
            text += fmt::format("  {} scale: {} translate: {}, {}, {}\n", what, 0.3 + 0.1 * part, number(),
                                number(), number());
        }
        text += "}\n";
    }
    return text;
}

/// A leaf as three images of points and its colour, to be compared.
std::array<double, 12> facts(const SceneLeaf& leaf, const UnfoldedScene& scene) {
    std::array<double, 12> all{};
    const Affine& map = leaf.world_from_shape;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(3 * i);
        const Vec3 image = map.linear[i] + map.translation;
        all[at] = image.x, all[at + 1] = image.y, all[at + 2] = image.z;
        all[9 + static_cast<std::size_t>(i)] = scene.nodes[leaf.node].look.colour()[i];
    }
    return all;
}

/// The leaves below all meshes, sorted.
std::vector<std::array<double, 12>> leaves(const UnfoldedScene& scene, const std::vector<MeshPlace>& places) {
    std::vector<std::array<double, 12>> found;
    for (const MeshPlace& place : places)
        walk_leaves(scene, place.mesh, place.world_from_mesh, {}, [&](const SceneLeaf& leaf) {
            found.push_back(facts(leaf, scene));
            return true;
        });
    std::ranges::sort(found);
    return found;
}

std::optional<UnfoldedScene> resolved_scene(const std::string& text) {
    Exporting exporting("m.inst", text);
    const auto scene = exporting.scene(SceneMeshes::shared);
    return scene ? resolve_looks(*scene, {}, {}, exporting.compilation.diagnostics) : std::nullopt;
}

/// Ways from the root to a part that bears the name, and not on to another below it.
std::size_t ways_to(const UnfoldedScene& scene, SceneId from, const std::string& name) {
    if (scene.nodes[from].name == name) return 1;
    std::size_t ways = 0;
    for (const ScenePart& part : scene.nodes[from].parts)
        ways += ways_to(scene, part.node, name);
    return ways;
}

TEST(HeldParts, AreMeshesOfTheirOwn) {
    std::optional<UnfoldedScene> scene = resolved_scene(tree);
    ASSERT_TRUE(scene);
    const auto before = leaves(*scene, {{scene->root, {}}});
    ASSERT_EQ(before.size(), 8u);
    Diagnostics diagnostics;
    const auto held = hold_parts(*scene, {"leaf"}, {}, diagnostics);
    ASSERT_TRUE(held);
    const MeshGroups groups =
        group_meshes(*scene, {.most_nodes = 100, .triangles_of_node = 1e9, .held = *held});
    const std::vector<MeshPlace> places = places_of(*scene, groups);
    const auto of_leaves = std::ranges::count_if(
        places, [&](const MeshPlace& place) { return scene->nodes[place.mesh].name == "leaf"; });
    EXPECT_EQ(of_leaves, 5);
    EXPECT_EQ(places.size(), 6u); // where nodes are dear, all wood is one mesh
    EXPECT_EQ(groups.meshes.size(), 2u);
    EXPECT_EQ(leaves(*scene, places), before);
}

/// The meshes that bear the name.
std::size_t meshes_called(const UnfoldedScene& scene, const MeshGroups& groups, const std::string& name) {
    return static_cast<std::size_t>(
        std::ranges::count_if(groups.meshes, [&](SceneId mesh) { return scene.nodes[mesh].name == name; }));
}

/// Sizes are told apart for the meshes of curved surfaces, which a blade does not have.
TEST(HeldParts, AreOneMeshHoweverLargeTheyAre) {
    const auto text = [](const std::string& look, const std::string& other_look) {
        return "canonical object leaf {\n triangle scale: 0.1\n triangle scale: 0.1 rotate: y 90\n}\n"
               "canonical object twig {\n leaf\n leaf scale: 0.3\n}\n"
               "object tree {\n leaf scale: 3" +
               look + "\n leaf translate: 1, 0, 0\n twig scale: 0.1" + other_look +
               "\n twig scale: 0.02 translate: 2, 0, 0\n sphere scale: 0.1\n}\n";
    };
    const std::string red = " tint: 1, 0, 0, 0.5";
    for (const auto& [model, meshes] :
         {std::pair(text("", ""), 1u), {text(red, ""), 2u}, {text(red, red), 2u}}) {
        Exporting exporting("m.inst", model);
        const auto by_size = exporting.scene(SceneMeshes::by_size);
        ASSERT_TRUE(by_size);
        auto scene = resolve_looks(*by_size, {}, {}, exporting.compilation.diagnostics);
        ASSERT_TRUE(scene);
        EXPECT_GT(std::ranges::count(scene->nodes, "leaf", &SceneNode::name), meshes);
        const auto before = leaves(*scene, {{scene->root, {}}});
        const auto held = hold_parts(*scene, {"leaf"}, {}, exporting.compilation.diagnostics);
        ASSERT_TRUE(held);
        const MeshGroups groups =
            group_meshes(*scene, {.most_nodes = 100, .triangles_of_node = 1e9, .held = *held});
        EXPECT_EQ(meshes_called(*scene, groups, "leaf"), meshes) << model;
        const std::vector<MeshPlace> places = places_of(*scene, groups);
        EXPECT_EQ(places.size(), 7u); // six leaves, and the rest
        const auto after = leaves(*scene, places);
        ASSERT_EQ(after.size(), before.size());
        for (std::size_t leaf = 0; leaf < after.size(); ++leaf)
            for (std::size_t fact = 0; fact < 12; ++fact)
                EXPECT_NEAR(after[leaf][fact], before[leaf][fact], 1e-12);
    }
}

TEST(HeldParts, AreAllObjectsByAStar) {
    const std::pair<std::vector<std::string>, std::size_t> cases[] = {
        {{"*"}, 8},         // five leaves, the wood of two twigs, the trunk
        {{"leaf", "*"}, 8}, // leaves are so already
        {{"twig", "*"}, 4}, // two twigs with their leaves, a leaf, the trunk
    };
    for (const auto& [names, count] : cases) {
        std::optional<UnfoldedScene> scene = resolved_scene(tree);
        ASSERT_TRUE(scene);
        const auto before = leaves(*scene, {{scene->root, {}}});
        Diagnostics diagnostics;
        const auto held = hold_parts(*scene, names, {}, diagnostics);
        ASSERT_TRUE(held);
        const MeshGroups groups =
            group_meshes(*scene, {.most_nodes = 100, .triangles_of_node = 1e9, .held = *held});
        const std::vector<MeshPlace> places = places_of(*scene, groups);
        EXPECT_EQ(places.size(), count) << names.front();
        for (const char* const name : {"leaf", "twig", "tree"})
            EXPECT_EQ(meshes_called(*scene, groups, name), 1u) << name;
        EXPECT_EQ(leaves(*scene, places), before);
    }
}

/// Each shape is in a mesh of the object that draws it.
TEST(HeldParts, ByAStarChangeNoLeafOfRandomGraphs) {
    std::mt19937 random(12);
    for (int i = 0; i < 100; ++i) {
        std::optional<UnfoldedScene> scene =
            resolved_scene(random_graph(random, 4 + static_cast<int>(random() % 4)));
        ASSERT_TRUE(scene);
        const auto before = leaves(*scene, {{scene->root, {}}});
        Diagnostics diagnostics;
        const auto held = hold_parts(*scene, {"*"}, {}, diagnostics);
        ASSERT_TRUE(held);
        const MeshGroups groups =
            group_meshes(*scene, {.most_nodes = 1e6, .triangles_of_node = 1e9, .held = *held});
        const std::vector<MeshPlace> places = places_of(*scene, groups);
        for (const MeshPlace& place : places)
            for (const ScenePart& part : scene->nodes[place.mesh].parts)
                EXPECT_TRUE(scene->nodes[part.node].shape) << i;
        const auto after = leaves(*scene, places);
        ASSERT_EQ(after.size(), before.size()) << i;
        for (std::size_t leaf = 0; leaf < after.size(); ++leaf)
            for (std::size_t fact = 0; fact < 12; ++fact)
                EXPECT_NEAR(after[leaf][fact], before[leaf][fact], 1e-9) << i;
    }
}

TEST(HeldParts, ChangeNoLeafOfRandomGraphs) {
    std::mt19937 random(11);
    std::size_t held_ones = 0;
    for (int i = 0; i < 100; ++i) {
        const int objects = 4 + static_cast<int>(random() % 4);
        std::optional<UnfoldedScene> scene = resolved_scene(random_graph(random, objects));
        ASSERT_TRUE(scene);
        const std::string name = fmt::format("o{}", random() % static_cast<unsigned>(objects));
        const std::size_t ways = ways_to(*scene, scene->root, name);
        const auto before = leaves(*scene, {{scene->root, {}}});
        Diagnostics diagnostics;
        const auto held = hold_parts(*scene, {name}, {}, diagnostics);
        ASSERT_EQ(held.has_value(), !diagnostics.has_errors());
        if (!held) continue;
        held_ones += ways;
        for (const double cost : {0.01, 1e9}) {
            const MeshGroups groups =
                group_meshes(*scene, {.most_nodes = 1e6, .triangles_of_node = cost, .held = *held});
            const std::vector<MeshPlace> places = places_of(*scene, groups);
            std::size_t found = 0;
            for (const MeshPlace& place : places) {
                found += (*held)[place.mesh];
                if (!(*held)[place.mesh]) {
                    EXPECT_EQ(ways_to(*scene, place.mesh, name), 0u);
                }
            }
            EXPECT_EQ(found, ways) << i;
            const auto after = leaves(*scene, places);
            ASSERT_EQ(after.size(), before.size()) << i;
            for (std::size_t leaf = 0; leaf < after.size(); ++leaf)
                for (std::size_t fact = 0; fact < 12; ++fact)
                    EXPECT_NEAR(after[leaf][fact], before[leaf][fact], 1e-9) << i;
        }
    }
    EXPECT_GT(held_ones, 50u);
}

TEST(HeldParts, RefuseANameThatNoPartHas) {
    std::optional<UnfoldedScene> scene = resolved_scene(tree);
    ASSERT_TRUE(scene);
    Diagnostics diagnostics;
    EXPECT_FALSE(hold_parts(*scene, {"leef"}, {}, diagnostics));
    const std::string said = diagnostics.render(SourceMap());
    EXPECT_THAT(said, HasSubstr("no part of the file is called 'leef'"));
    EXPECT_THAT(said, HasSubstr("leaf"));
}

TEST(HeldParts, HaveNodesOfTheirOwnInGltf) {
    Exporting exporting("m.inst", tree);
    exporting.options.file.parts = {"leaf"};
    ASSERT_TRUE(exporting.to("m.gltf"))
        << exporting.compilation.diagnostics.render(exporting.compilation.sources);
    const std::string text = exporting.read("m.gltf");
    std::size_t named = 0;
    for (std::size_t at = text.find("\"leaf\""); at != std::string::npos; at = text.find("\"leaf\"", at + 1))
        ++named;
    EXPECT_EQ(named, 6u); // five nodes, and the mesh
    exporting.options.file.nodes = 3;
    exporting.options.error_asked = true;
    EXPECT_FALSE(exporting.to("m.gltf"));
    EXPECT_THAT(exporting.compilation.diagnostics.render(exporting.compilation.sources),
                HasSubstr("with each --part by itself"));
}

} // namespace
} // namespace graftal
