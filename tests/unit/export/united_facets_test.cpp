// A leaf of several triangles is one mesh.

#include "runtime/export/united_facets.h"

#include <algorithm>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/primitives/tessellate.h"
#include "compiler/unfolded/looks.h"
#include "tests/unit/export/exporting.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

std::size_t count_of(const std::string& text, const std::string& words) {
    std::size_t count = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
        ++count;
    return count;
}

const std::string leaf = "{.+(30)f-(40)f-(40)f-(50)f}"; // three triangles

TEST(UnitedFacets, ALeafIsOneMeshInUsd) {
    Exporting exporting("m.lsys", "lsys leaf { steps 0\n axiom " + leaf +
                                      "\n}\nmain lsys s { steps 0\n axiom ~leaf+(90)f(3)~leaf\n}\n");
    ASSERT_TRUE(exporting.to("m.usda")) << exporting.said();
    const std::string usd = exporting.read("m.usda");
    EXPECT_EQ(count_of(usd, "def Mesh"), 1u);
    EXPECT_THAT(usd, HasSubstr("int[] faceVertexCounts = [3, 3, 3]"));
    const std::size_t points = usd.find("point3f[] points = [");
    ASSERT_NE(points, std::string::npos);
    EXPECT_EQ(count_of(usd.substr(points, usd.find(']', points + 20) - points), "("), 5u);
    EXPECT_EQ(count_of(usd, "def Xform \"p"), 3u); // the two leaves, and the mesh in their master
}

// Triangles and their area stay as they are.
TEST(UnitedFacets, KeepTheDrawing) {
    const std::string materials = "material red { color: 1, 0, 0 }\nmaterial leafy { color: 0, 1, 0 }\n";
    Exporting exporting("m.lsys", materials + "lsys m { steps 0\n width 0.2\n colors red, leafy\n axiom F" +
                                      leaf + ";F/(90)" + leaf + leaf + "\n}\n");
    std::optional<UnfoldedScene> scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene) << exporting.said();
    scene = resolve_looks(*scene, {}, {}, exporting.compilation.diagnostics);
    ASSERT_TRUE(scene);
    const auto area = [&] {
        double sum = 0;
        walk_leaves(*scene, scene->root, {}, {}, [&](const SceneLeaf& at) {
            const Primitive& primitive = scene->shapes[at.shape].primitive;
            const TessellatedPrimitive& mesh = tessellated(primitive, 0);
            if (!mesh.normals.empty() && primitive != PrimitiveKind::mesh) return true; // round
            for (const auto& [a, b, c] : mesh.triangles) {
                const Vec3 corner = at.world_from_shape(mesh.vertices[a]);
                sum += glm::length(glm::cross(at.world_from_shape(mesh.vertices[b]) - corner,
                                              at.world_from_shape(mesh.vertices[c]) - corner)) /
                       2;
            }
            return true;
        });
        return sum;
    };
    const SceneCounts before = count(*scene);
    const double area_before = area();
    unite_facets(*scene);
    const SceneCounts after = count(*scene);
    EXPECT_EQ(after.triangles, before.triangles);
    EXPECT_EQ(before.leaves - after.leaves, 9 - 3); // a mesh for each polygon
    EXPECT_GT(area_before, 1);
    EXPECT_NEAR(area(), area_before, 1e-9);
}

// Triangles that meet in corners only, or at an angle, are parts by themselves.
TEST(UnitedFacets, ShareSidesInOnePlane) {
    const auto leaves_of = [](const std::string& places) {
        Exporting exporting("m.inst", "object m {\n triangle\n" + places + "}\n");
        std::optional<UnfoldedScene> scene = exporting.scene(SceneMeshes::shared);
        EXPECT_TRUE(scene) << exporting.said();
        scene = resolve_looks(*scene, {}, {}, exporting.compilation.diagnostics);
        unite_facets(*scene);
        return count(*scene).leaves;
    };
    EXPECT_EQ(leaves_of(" triangle rotate: z, 180 translate: 0, -1, 0\n"), 1); // below the side at y = -0.5
    EXPECT_EQ(leaves_of(" triangle translate: 0, -1.5, 0\n"), 2);              // its apex on that side
    EXPECT_EQ(leaves_of(" triangle rotate: z, 180 translate: 0, -1, 0\n"
                        " triangle translate: 0, 0, 1\n"),
              2);
    EXPECT_EQ(leaves_of(" triangle translate: 0, 0.5, 0 rotate: x, 90 translate: 0, -0.5, 0\n"), 2);
}

// A picture covers a triangle in its own way, and that would be lost.
TEST(UnitedFacets, LeavePicturesAlone) {
    const std::string text = "material bark { texture: \"bark.png\" }\nobject m {\n triangle material: bark\n"
                             " triangle material: bark translate: 3, 0, 0\n}\n";
    Exporting exporting("m.inst", text);
    write_bark(exporting);
    std::optional<UnfoldedScene> scene = exporting.scene(SceneMeshes::shared);
    ASSERT_TRUE(scene) << exporting.said();
    scene = resolve_looks(*scene, {}, {}, exporting.compilation.diagnostics);
    ASSERT_TRUE(scene);
    const std::size_t nodes = scene->nodes.size();
    unite_facets(*scene);
    EXPECT_EQ(scene->nodes.size(), nodes);
    EXPECT_EQ(count(*scene).leaves, 2);
}

} // namespace
} // namespace graftal
