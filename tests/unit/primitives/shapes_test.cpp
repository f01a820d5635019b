#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/primitives/intersect.h"
#include "compiler/primitives/polygon_rings.h"
#include "compiler/primitives/texture_space.h"
#include "tests/unit/primitives/sample_shapes.h"

namespace graftal {
namespace {

using test::made_of;
using testing::HasSubstr;

std::string fault_of(PrimitiveKind kind, const std::vector<double>& numbers) {
    std::string fault;
    EXPECT_FALSE(traits_of(kind).make(numbers, fault));
    return fault;
}

TEST(Superellipsoid, IsASphereOctahedronOrCylinderAtItsEnds) {
    const auto reach = [](double e, double n, Vec3 direction) {
        return primitive_support(made_of(PrimitiveKind::superellipsoid, {e, n}), direction);
    };
    EXPECT_NEAR(reach(1, 1, {1, 2, 2}), 3, 1e-12);   // a sphere
    EXPECT_NEAR(reach(2, 2, {0.5, 2, 1}), 2, 1e-12); // an octahedron
    EXPECT_NEAR(reach(1, 0.1, {3, 1, 4}), 6, 0.2);   // nearly a cylinder: 5 + 1
    EXPECT_NEAR(reach(1, 2, {3, 1, 4}), 5, 1e-12);   // a double cone
    EXPECT_NEAR(traits_of(PrimitiveKind::superellipsoid).area(made_of(PrimitiveKind::superellipsoid, {1, 1})),
                4 * 3.14159265, 0.02);
}

/// The greatest length has a closed form whose powers leave the range of doubles near n = 1.
TEST(Superellipsoid, HasASmallBallAtAnyExponents) {
    for (const double e : {0.1, 0.5, 1.0, 2.0})
        for (double n = 0.9; n < 1.1; n += 1.0 / 4096) {
            const Primitive shape = made_of(PrimitiveKind::superellipsoid, {e, n});
            double farthest = 0;
            for (const Vec3& vertex : traits_of(shape).mesh(shape, 1).vertices)
                farthest = std::max(farthest, glm::length(vertex));
            const double radius = traits_of(shape).ball(shape).radius;
            EXPECT_GE(radius, farthest) << e << " " << n;
            EXPECT_LE(radius, 1.01 * farthest) << e << " " << n;
        }
}

TEST(Superellipsoid, RefusesOtherExponents) {
    EXPECT_THAT(fault_of(PrimitiveKind::superellipsoid, {0.05, 1}), HasSubstr("between 0.1 and 2"));
    EXPECT_THAT(fault_of(PrimitiveKind::superellipsoid, {1, 2.5}), HasSubstr("not at 2.5"));
}

TEST(Superellipsoid, IsNamedByItsNumbers) {
    const Primitive shape = made_of(PrimitiveKind::superellipsoid, {0.25, 1});
    EXPECT_EQ(name_of(shape), "superellipsoid(0.25, 1)");
    EXPECT_EQ(shape, made_of(PrimitiveKind::superellipsoid, {0.25, 1}));
    EXPECT_NE(shape, made_of(PrimitiveKind::superellipsoid, {1, 0.25}));
}

TEST(Polygon, LeavesHolesAndFillsIslands) {
    const Primitive frame = made_of(PrimitiveKind::polygon, test::framed_square());
    EXPECT_NEAR(traits_of(frame).area(frame), 4 - 1 + 0.08, 1e-12);
    PrimitiveHit hit;
    EXPECT_TRUE(intersect(frame, {{0.7, 0.7, 1}, {0, 0, -1}}, {}, hit));
    EXPECT_FALSE(intersect(frame, {{0.4, -0.4, 1}, {0, 0, -1}}, {}, hit));
    EXPECT_TRUE(intersect(frame, {{0.1, -0.1, 1}, {0, 0, -1}}, {}, hit));
    EXPECT_FALSE(intersect(frame, {{1.1, 0, 1}, {0, 0, -1}}, {}, hit));
}

TEST(Polygon, TrianglesFillTheOutlineWhateverItsForm) {
    // Combs with many teeth, which have few ears, with a hole in their backs.
    for (int teeth = 1; teeth < 40; teeth += 7) {
        std::vector<double> numbers = {0, -2};
        for (int i = 0; i < teeth; ++i)
            numbers.insert(numbers.end(), {2.0 * i, 0.0, 2.0 * i + 0.5, 3.0});
        numbers.insert(numbers.end(), {2.0 * teeth, 0.0, 2.0 * teeth, -2.0, 0, -2});
        numbers.insert(numbers.end(), {0.5, -1.5, 0.6, -0.5, 0.7, -1.5});
        const Primitive comb = made_of(PrimitiveKind::polygon, numbers);
        double area = 2.0 * 2.0 * teeth - 0.1;
        for (int i = 0; i < teeth; ++i)
            area += 0.5 * 2.0 * 3.0;
        EXPECT_NEAR(traits_of(comb).area(comb), area, 1e-9) << teeth;
    }
}

TEST(Polygon, RefusesOutlinesThatAreNone) {
    EXPECT_THAT(fault_of(PrimitiveKind::polygon, {0, 0, 2, 2, 2, 0, 0, 1}), HasSubstr("meets itself"));
    EXPECT_THAT(fault_of(PrimitiveKind::polygon, {0, 0, 1, 0, 0, 0, 0, 1}), HasSubstr("three corners"));
    EXPECT_THAT(fault_of(PrimitiveKind::polygon, {0, 0, 1, 1, 2, 2}), HasSubstr("no area"));
    EXPECT_THAT(fault_of(PrimitiveKind::polygon, {0, 0, 1, 0, 1, 0, 0, 1}), HasSubstr("one point"));
    EXPECT_THAT(fault_of(PrimitiveKind::polygon, {0, 0, 1, 0, 0, 1, 2}), HasSubstr("two coordinates"));
    EXPECT_THAT(fault_of(PrimitiveKind::polygon, {0, 0, 5000, 0, 0, 1}), HasSubstr("between"));
}

TEST(Patch, PassesThroughItsCornersAndAlongItsEdges) {
    const Primitive patch = made_of(PrimitiveKind::bicubic_patch, test::sail(false));
    const TessellatedPrimitive mesh = traits_of(patch).mesh(patch, 0);
    EXPECT_EQ(mesh.vertices.size(), 33u * 33u);
    EXPECT_NEAR(glm::distance(mesh.vertices.front(), Vec3(0, 0, 0)), 0, 1e-15);
    EXPECT_NEAR(glm::distance(mesh.vertices.back(), Vec3(2, 2, 0.3)), 0, 1e-15);
    // In the middle each polynomial is 1/8 or 3/8: four inner points at 1, and the edges' rise of 0.15.
    const double middle = 4 * 9 / 64.0 + 0.15 * (16 - 4 * 9 / 4.0) / 64 * 4;
    PrimitiveHit hit;
    ASSERT_TRUE(intersect(patch, {{1, 1, 5}, {0, 0, -1}}, {}, hit));
    EXPECT_NEAR(5 - hit.t, mesh.vertices[16 * 33 + 16].z, 1e-12);
    EXPECT_NEAR(mesh.vertices[16 * 33 + 16].z, middle, 0.02);
    EXPECT_GT(hit.normal.z, 0.9);
}

TEST(Patch, OfPointsInAPlaneIsFlat) {
    std::vector<double> numbers;
    for (int i = 0; i < 16; ++i)
        numbers.insert(numbers.end(), {double(i % 4), double(i / 4), 2.0});
    const Primitive patch = made_of(PrimitiveKind::bicubic_patch, numbers);
    EXPECT_NEAR(traits_of(patch).area(patch), 9, 1e-12);
    const Box box = traits_of(patch).box(patch);
    EXPECT_NEAR(box.min.z, 2, 1e-12);
    EXPECT_NEAR(box.max.z, 2, 1e-12);
}

TEST(Patch, HasNormalsWhereAnEdgeIsAPoint) {
    const Primitive patch = made_of(PrimitiveKind::bicubic_patch, test::sail(true));
    for (const Vec3& normal : traits_of(patch).mesh(patch, 0).normals) {
        EXPECT_NEAR(glm::length(normal), 1, 1e-12);
        EXPECT_GT(normal.z, 0);
    }
}

TEST(Patch, RefusesPointsOnALineAndNumbersOutOfRange) {
    std::vector<double> line;
    for (int i = 0; i < 16; ++i)
        line.insert(line.end(), {double(i), 2.0 * i, 0.0});
    EXPECT_THAT(fault_of(PrimitiveKind::bicubic_patch, line), HasSubstr("no area"));
    line[5] = 1e9;
    EXPECT_THAT(fault_of(PrimitiveKind::bicubic_patch, line), HasSubstr("between -1000 and 1000, not 1e+09"));
}

/// The surface that a ball sweeps along a line while its radius goes from one to another (I. Quilez's "round
/// cone"): how far a point lies outside of it.
double outside_round_cone(Vec3 p, double length, double r1, double r2) {
    const double b = (r1 - r2) / length, a = std::sqrt(1 - b * b);
    const double x = std::hypot(p.x, p.z), k = a * p.y - b * x;
    if (k < 0) return std::hypot(x, p.y) - r1;
    if (k > a * length) return std::hypot(x, p.y - length) - r2;
    return a * x + b * p.y - r1;
}

TEST(SphereSweep, OfTwoBallsIsTheirRoundCone) {
    for (const double top : {0.5, 0.2, 0.0, 0.9}) {
        const Primitive sweep = made_of(PrimitiveKind::sphere_sweep, {0, 0, 0, 0.5, 0, 1.5, 0, top});
        for (const Vec3& vertex : traits_of(sweep).mesh(sweep, 0).vertices)
            EXPECT_NEAR(outside_round_cone(vertex, 1.5, 0.5, top), 0, 1e-12) << top;
        const double support = primitive_support(sweep, {0, 1, 0});
        EXPECT_NEAR(support, 1.5 + top, 1e-12);
        EXPECT_NEAR(primitive_support(sweep, {0, -1, 0}), 0.5, 1e-12);
    }
}

TEST(SphereSweep, RunsThroughItsPointsWithoutATwist) {
    const std::vector<Vec3> points = {{0, 0, 0}, {0, 2, 0}, {2, 2, 1}, {1, 0, 2}};
    std::vector<double> numbers;
    for (const Vec3& point : points)
        numbers.insert(numbers.end(), {point.x, point.y, point.z, 0.1});
    const Primitive sweep = made_of(PrimitiveKind::sphere_sweep, numbers);
    // A ray through each point meets the tube about it.
    for (const Vec3& point : points)
        for (const Vec3 way : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
            PrimitiveHit hit;
            EXPECT_TRUE(intersect(sweep, {point, way}, {0, 3}, hit));
        }
    // No triangle spans more than its share of the curve: rings that were turned would be wrung out.
    const TessellatedPrimitive mesh = traits_of(sweep).mesh(sweep, 0);
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 normal =
            glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
        EXPECT_GT(glm::dot(normal, mesh.normals[a] + mesh.normals[b] + mesh.normals[c]), 0);
    }
}

TEST(SphereSweep, RefusesWhatIsNoSweep) {
    const PrimitiveKind kind = PrimitiveKind::sphere_sweep;
    EXPECT_THAT(fault_of(kind, {0, 0, 0, 1, 0, 1, 0, 1, 3}), HasSubstr("four numbers for each point"));
    EXPECT_THAT(fault_of(kind, {0, 0, 0, 1, 0, 0, 0, 2}), HasSubstr("are the same"));
    EXPECT_THAT(fault_of(kind, {0, 0, 0, 0, 0, 1, 0, 0}), HasSubstr("its radii are too small"));
    EXPECT_THAT(fault_of(kind, {0, 0, 0, -1, 0, 1, 0, 1}), HasSubstr("between 0 and 1000, not -1"));
    EXPECT_THAT(fault_of(kind, {0, 0, 1e300, 1, 0, 1, 0, 1}), HasSubstr("not 1e+300"));
}

TEST(Mesh, NormalsRunEvenlyOverItsTriangles) {
    MeshData roof;
    roof.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    roof.normals = {{0, 0, 1}, {0.6, 0, 0.8}, {0, 0, 1}};
    roof.triangles = {{0, 1, 2}};
    const Primitive mesh = mesh_primitive("roof.obj", roof);
    PrimitiveHit hit;
    ASSERT_TRUE(intersect(mesh, {{0.5, 0.25, 3}, {0, 0, -1}}, {}, hit));
    EXPECT_NEAR(glm::distance(hit.normal, glm::normalize(Vec3(0.3, 0, 0.9))), 0, 1e-12);
}

constexpr double turn = 2 * 3.14159265358979;

/// Needles about one point, in a plane askew.
MeshData fan_of(std::uint32_t needles) {
    MeshData fan;
    fan.vertices = {{0, 0, 0}};
    for (std::uint32_t i = 0; i < needles; ++i) {
        const double x = std::cos(turn * i / needles), y = std::sin(turn * i / needles);
        fan.vertices.push_back({x, y, 0.3 * x - 0.6 * y});
        fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % needles});
    }
    return fan;
}

/// Large triangles of one plane askew, any of which may hold a point.
MeshData pile_of(std::uint32_t count) {
    MeshData pile;
    for (std::uint32_t i = 0; i < 3 * count; ++i) {
        const double angle = turn * (i % 3) / 3 + 0.001 * i, x = std::cos(angle), y = std::sin(angle);
        pile.vertices.push_back({x, y, 0.3 * x - 0.6 * y});
        if (i % 3 == 2) pile.triangles.push_back({i - 2, i - 1, i});
    }
    return pile;
}

/// The most steps of rays that come from the front, of so many that are allowed.
std::uint64_t most_steps(const MeshData& data, std::uint64_t allowed = UINT64_MAX) {
    const Primitive mesh = mesh_primitive("m.obj", data);
    std::uint64_t most = 0;
    for (int i = 0; i < 400; ++i) {
        const double radius = 0.001 + 0.4 * i / 400, angle = 2.4 * i;
        const Vec3 from(radius * std::cos(angle), radius * std::sin(angle), 5);
        PrimitiveHit hit;
        EXPECT_TRUE(intersect(mesh, {from, {0.01, 0.02, -1}}, {}, hit, allowed));
        most = std::max(most, hit.steps);
    }
    return most;
}

/// Powers take longer than what other plain primitives ask for: their rays are dear, and count so.
TEST(Superellipsoid, ARayCountsItsPowers) {
    const Primitive body = made_of(PrimitiveKind::superellipsoid, {0.3, 0.4});
    PrimitiveHit hit;
    EXPECT_TRUE(intersect(body, {{0.1, 0.2, 5}, {0.01, 0.02, -1}}, {}, hit));
    EXPECT_GE(hit.steps, 20u);
    EXPECT_LE(hit.steps, 2000u);
    EXPECT_FALSE(intersect(body, {{3, 0.2, 5}, {0, 0, -1}}, {}, hit));
    EXPECT_EQ(hit.steps, 0u) << "it passes by the box";
}

TEST(Mesh, RaysComeToFewOfManyTriangles) {
    EXPECT_LT(most_steps(fan_of(20000)), 1000u);
    EXPECT_LT(most_steps(pile_of(20000)), 300u);
}

TEST(Mesh, ARayTakesNoMoreStepsThanAreAllowed) {
    constexpr std::uint64_t allowed = 20, a_leaf = 8;
    EXPECT_GT(most_steps(pile_of(20000)), 2 * allowed);
    EXPECT_LE(most_steps(pile_of(20000), allowed), allowed + a_leaf);
}

TEST(Mesh, RaysAlongEdgesMeetIt) {
    // Parts of a fan are turned to where they belong, so that their corners differ by rounding.
    for (int needles = 3; needles < 40; ++needles) {
        MeshData fan;
        for (int i = 0; i < needles; ++i)
            for (const double side : {-1.0, 0.0, 1.0}) {
                const double angle = turn * i / needles + side * turn / 2 / needles;
                const double radius = side == 0 ? 0 : 1 / std::cos(turn / 2 / needles);
                fan.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
                if (side == 1) {
                    const auto last = static_cast<std::uint32_t>(fan.vertices.size() - 1);
                    fan.triangles.push_back({last - 2, last - 1, last});
                }
            }
        const Primitive mesh = mesh_primitive("fan.obj", fan);
        for (int i = 0; i < 2 * needles; ++i)
            for (int k = 0; k < 20; ++k) {
                const double angle = turn * i / 2 / needles, at = 0.99 * k / 20;
                const Vec3 edge(at * std::cos(angle), at * std::sin(angle), 0);
                for (const Vec3& way : {Vec3(0, 0, -1), Vec3(0.3, -0.8, -0.5)}) {
                    PrimitiveHit hit;
                    EXPECT_TRUE(intersect(mesh, {edge - 2.0 * way, way}, {}, hit))
                        << needles << " " << i << " " << k;
                }
            }
    }
}

TEST(Polygon, RaysAlongASharedEdgeMeetIt) {
    const double c = std::cos(turn / 20), s = std::sin(turn / 20);
    const Primitive wedge = made_of(PrimitiveKind::polygon, {0, 0, c, s, c, -s});
    for (int k = 0; k < 1000; ++k)
        for (const double side : {-1.0, 1.0})
            for (const double off : {-1e-15, 0.0, 1e-15}) {
                const double at = 0.99 * k / 1000;
                PrimitiveHit hit;
                EXPECT_TRUE(intersect(wedge, {{at * c + off, side * at * s, 1}, {0, 0, -1}}, {}, hit));
            }
    PrimitiveHit hit;
    EXPECT_FALSE(intersect(wedge, {{0.5 * c, 0.5 * s + 1e-8, 1}, {0, 0, -1}}, {}, hit));
    EXPECT_FALSE(intersect(wedge, {{c + 1e-8, 0, 1}, {0, 0, -1}}, {}, hit));
}

TEST(Mesh, KeepsTheFilesPictures) {
    const Primitive mesh = mesh_primitive("tetrahedron.obj", test::tetrahedron());
    EXPECT_EQ(name_of(mesh), "mesh(\"tetrahedron.obj\")");
    const auto uv =
        texture_coordinates(mesh, TextureSpace(), std::array{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)});
    EXPECT_NEAR(uv[1][0], 1, 1e-12);
    EXPECT_NEAR(uv[2][1], 1, 1e-12);
}

} // namespace
} // namespace graftal
