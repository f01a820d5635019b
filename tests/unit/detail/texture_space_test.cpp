#include "compiler/primitives/texture_space.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/detail/mesh/builder.h"
#include "compiler/primitives/mesh_file.h"
#include "compiler/primitives/tessellate.h"

namespace graftal {
namespace {

using std::numbers::pi;

TEST(TextureSpace, PicturesKeepTheirProportionsAsWholeOnes) {
    // A circumference of 2 pi, and as long, half as long, 3.4 times and hardly at all.
    for (const auto& [length, around, along] : {std::array{2 * pi, 1.0, 1.0},
                                                {pi, 1.0, 1.0},
                                                {6.8 * pi, 1.0, 3.0},
                                                {6.8 * pi, 2.0, 7.0},
                                                {1e-9, 5.0, 1.0}}) {
        const double turns = length_in_turns(Mat3(1, 0, 0, 0, length, 0, 0, 0, 1));
        const TextureSpace space = texture_space(PrimitiveKind::cylinder, around, turns);
        EXPECT_EQ(space.around, around);
        EXPECT_EQ(space.along, along) << length;
    }
    EXPECT_EQ(texture_space(PrimitiveKind::sphere, 3, 100).along, 1);
    EXPECT_EQ(texture_space(PrimitiveKind::cube, 3, 100).around, 1);
    EXPECT_EQ(length_in_turns(Mat3(0.0)), 0);
}

TEST(TextureSpace, RunsRoundAndUpwards) {
    const TextureSpace once;
    const auto near = [](std::array<double, 2> found, double u, double v) {
        return std::abs(found[0] - u) + std::abs(found[1] - v) < 1e-12;
    };
    const auto at = [&](const Primitive& kind, Vec3 point) { return texture_coordinates(kind, once, point); };
    EXPECT_TRUE(near(at(PrimitiveKind::cylinder, {0, 0.25, 1}), 0, 0.25));
    EXPECT_TRUE(near(at(PrimitiveKind::cylinder, {1, 0.25, 0}), 0.25, 0.25));
    EXPECT_TRUE(near(at(PrimitiveKind::cone, {-0.5, 0.5, 0}), -0.25, 0.5));
    EXPECT_TRUE(near(at(PrimitiveKind::sphere, {0, 1, 0}), 0, 1));
    EXPECT_TRUE(near(at(PrimitiveKind::sphere, {0, 0, 1}), 0, 0.5));
    EXPECT_TRUE(near(at(PrimitiveKind::torus, {0, 0.25, 1}), 0, 0.25));
    EXPECT_TRUE(near(at(PrimitiveKind::cube, {-1, 1, 0.3}), 0, 1));
    EXPECT_TRUE(near(at(PrimitiveKind::triangle, {-std::sqrt(3.0) / 2, -0.5, 0}), 0, 0));
    EXPECT_TRUE(near(at(PrimitiveKind::triangle, {0, 1, 0}), 0.5, 1));
    EXPECT_TRUE(near(texture_coordinates(PrimitiveKind::cylinder, {2, 3}, {1, 0.5, 0}), 0.5, 1.5));
}

TEST(TextureSpace, OfTheirOwnHaveSkinsPatchesAndSomeMeshes) {
    std::string fault;
    const auto limb = traits_of(PrimitiveKind::limb_sweep)
                          .make(std::vector<double>{6, 0, 0, 0, 0, 0, 0.1, 0, 1, 0, 0.1}, fault);
    ASSERT_TRUE(limb) << fault;
    EXPECT_TRUE(has_texture_points(*limb));
    MeshData data{
        .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {}, .triangles = {{0, 1, 2}}, .uv = {}};
    EXPECT_FALSE(has_texture_points(mesh_primitive("plain", data)));
    data.uv = {{{{0, 0}, {1, 0}, {0, 1}}}};
    EXPECT_TRUE(has_texture_points(mesh_primitive("mapped", data)));
    const auto polygon = traits_of(PrimitiveKind::polygon).make(std::vector<double>{0, 0, 1, 0, 0, 1}, fault);
    ASSERT_TRUE(polygon) << fault;
    for (const Primitive& other :
         {*polygon, Primitive(PrimitiveKind::cylinder), Primitive(PrimitiveKind::cube)})
        EXPECT_FALSE(has_texture_points(other));
}

/// Between the corners of a mesh's triangles the picture lies where it lies on the primitive.
TEST(TextureSpace, IsThatOfTheMeshes) {
    const TextureSpace space{2, 3};
    for (const Primitive& kind : std::initializer_list<Primitive>{
             PrimitiveKind::cylinder, tapered(0.5), PrimitiveKind::sphere, PrimitiveKind::torus,
             PrimitiveKind::cube, PrimitiveKind::triangle}) {
        MeshBuilder builder(true);
        builder.add_textured(kind, max_fineness(kind), {}, space, 0);
        builder.finish();
        const Mesh& mesh = builder.mesh;
        ASSERT_EQ(mesh.uv.size(), mesh.vertices.size());
        ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
        std::size_t looked_at = 0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0;
            // Caps and poles pull a line of the picture together.
            const bool round = kind != PrimitiveKind::cube && kind != PrimitiveKind::triangle;
            if (round && (std::hypot(middle.x, middle.z) < 0.4 || std::abs(mesh.normals[a].y) == 1)) continue;
            ++looked_at;
            const auto expected = texture_coordinates(kind, space, middle);
            for (std::size_t k = 0; k < 2; ++k) {
                const double found = (mesh.uv[a][k] + mesh.uv[b][k] + mesh.uv[c][k]) / 3;
                const double off = found - expected[k];
                EXPECT_NEAR(off, std::round(off), 0.02) << name_of(kind);
            }
        }
        EXPECT_GT(looked_at, 0u) << name_of(kind);
    }
}

} // namespace
} // namespace graftal
