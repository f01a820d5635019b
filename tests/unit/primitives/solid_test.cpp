#include "compiler/primitives/solid.h"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/primitives/intersect.h"
#include "compiler/primitives/triangle_mesh.h"
#include "tests/unit/primitives/all_primitives.h"

namespace graftal {
namespace {

using test::some_primitives;

/// A tetrahedron without its last `missing` faces; turned inside out if `inwards`.
Primitive tetrahedron(std::size_t missing, bool inwards) {
    MeshData data;
    data.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    data.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    data.triangles.resize(data.triangles.size() - missing);
    if (inwards)
        for (auto& triangle : data.triangles)
            std::swap(triangle[0], triangle[1]);
    return {PrimitiveKind::mesh, std::make_shared<const TriangleMesh>("mesh(\"t\")", std::move(data))};
}

TEST(Solid, encloses_volume_where_no_ray_gets_in_without_meeting_it) {
    for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::cube, PrimitiveKind::cylinder,
                                     PrimitiveKind::cone, PrimitiveKind::torus, PrimitiveKind::plane})
        EXPECT_TRUE(encloses_volume(kind)) << name_of(kind);
    EXPECT_FALSE(encloses_volume(PrimitiveKind::triangle));
    EXPECT_TRUE(encloses_volume(tetrahedron(0, false)));
    EXPECT_TRUE(encloses_volume(tetrahedron(0, true)));
    EXPECT_FALSE(encloses_volume(tetrahedron(1, false)));
    EXPECT_FALSE(encloses_volume(tetrahedron(3, false)));
}

TEST(Solid, is_entered_before_it_is_left_whichever_way_a_mesh_is_wound) {
    for (const Primitive& primitive : {Primitive(PrimitiveKind::sphere), Primitive(PrimitiveKind::cone),
                                       tetrahedron(0, false), tetrahedron(0, true)}) {
        const Ray ray{{0.1, 0.2, 3}, {0.01, -0.02, -1}};
        PrimitiveHit hit;
        ASSERT_TRUE(intersect(primitive, ray, {}, hit));
        EXPECT_FALSE(leaves_solid(primitive, ray, hit));
        ASSERT_TRUE(intersect(primitive, ray, {hit.t, INFINITY}, hit));
        EXPECT_TRUE(leaves_solid(primitive, ray, hit));
        EXPECT_FALSE(intersect(primitive, ray, {hit.t, INFINITY}, hit));
    }
}

TEST(Solid, has_the_volume_of_a_fine_mesh_of_it) {
    std::vector<Primitive> solids = some_primitives();
    std::string fault;
    for (const std::array<double, 2> exponents : {std::array{1.0, 1.0}, {0.3, 1.7}, {1.8, 0.5}, {2.0, 2.0}})
        solids.push_back(traits_of(PrimitiveKind::superellipsoid).make(exponents, fault).value());
    for (const auto& balls : {std::vector<double>{0, 0, 0, 0.3, 0, 1, 0, 0.2, 0.5, 2, 0, 0.1},
                              {0, 0, 0, 0.5, 0, 2, 0, 0.5},
                              {1, 0, 0, 0.2, 2, 0, 0, 0, 3, 1, 0, 0.3}}) {
        solids.push_back(traits_of(PrimitiveKind::sphere_sweep).make(balls, fault).value());
        EXPECT_TRUE(encloses_volume(solids.back())) << name_of(solids.back());
    }
    for (const Primitive& primitive : solids) {
        if (primitive == PrimitiveKind::plane) continue;
        const std::optional<double> volume = volume_of(primitive);
        if (!encloses_volume(primitive)) {
            EXPECT_EQ(volume, 0) << name_of(primitive);
            continue;
        }
        ASSERT_TRUE(volume) << name_of(primitive);
        const TessellatedPrimitive mesh =
            traits_of(primitive).mesh(primitive, traits_of(primitive).max_fineness);
        double meshed = 0;
        for (const auto& triangle : mesh.triangles)
            meshed += glm::dot(mesh.vertices[triangle[0]],
                               glm::cross(mesh.vertices[triangle[1]], mesh.vertices[triangle[2]])) /
                      6;
        EXPECT_NEAR(std::abs(meshed), *volume, 0.01 * *volume) << name_of(primitive);
    }
}

} // namespace
} // namespace graftal
