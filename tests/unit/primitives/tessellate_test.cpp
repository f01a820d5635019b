#include "compiler/primitives/tapered.h"
#include "compiler/primitives/tessellate.h"
#include "tests/unit/broken_invariant.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <tuple>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/primitives/all_primitives.h"

namespace graftal {
namespace {

const Primitive closed_kinds[] = {PrimitiveKind::sphere, PrimitiveKind::cube, PrimitiveKind::cylinder,
                                  PrimitiveKind::cone, PrimitiveKind::torus};
const Primitive curved_kinds[] = {PrimitiveKind::sphere, PrimitiveKind::cylinder, PrimitiveKind::cone,
                                  PrimitiveKind::torus,  tapered(0.75),           tapered(0.125)};

using Key = std::tuple<double, double, double>;
Key key(Vec3 p) {
    return {p.x, p.y, p.z};
}

/// Distance of (x, y) from the segment a-b of the plane.
double segment_distance(double x, double y, Vec3 a, Vec3 b) {
    const Vec3 p(x, y, 0), side = b - a;
    const double t = std::clamp(glm::dot(p - a, side) / glm::dot(side, side), 0.0, 1.0);
    return glm::length(p - a - t * side);
}

/// Distance from the true surface.
double distance(const Primitive& kind, Vec3 p) {
    const double out = std::hypot(p.x, p.z);
    switch (kind.kind()) {
    case PrimitiveKind::sphere:
        return std::abs(glm::length(p) - 1);
    case PrimitiveKind::torus:
        return std::abs(std::hypot(out - 1, p.y) - 0.25);
    case PrimitiveKind::cylinder:
    case PrimitiveKind::frustum:
        return std::min({segment_distance(out, p.y, {0, 0, 0}, {1, 0, 0}),
                         segment_distance(out, p.y, {1, 0, 0}, {top_radius(kind), 1, 0}),
                         segment_distance(out, p.y, {0, 1, 0}, {top_radius(kind), 1, 0})});
    case PrimitiveKind::cone:
        return std::min(segment_distance(out, p.y, {0, 0, 0}, {1, 0, 0}),
                        segment_distance(out, p.y, {1, 0, 0}, {0, 1, 0}));
    default:
        ADD_FAILURE();
        return 0;
    }
}

double volume(const TessellatedPrimitive& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += glm::dot(mesh.vertices[a], glm::cross(mesh.vertices[b], mesh.vertices[c])) / 6;
    return sum;
}

Vec3 face_normal(const TessellatedPrimitive& mesh, const std::array<std::uint32_t, 3>& t) {
    return glm::cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

TEST(Tessellate, EveryEdgeOfAClosedSurfaceIsSharedOnceEachWay) {
    for (const Primitive& kind : closed_kinds)
        for (int fineness = 0; fineness <= std::min(4, max_fineness(kind)); ++fineness) {
            const auto& mesh = tessellated(kind, fineness);
            std::map<std::pair<Key, Key>, int> edges;
            for (const auto& t : mesh.triangles)
                for (int i = 0; i < 3; ++i)
                    ++edges[{key(mesh.vertices[t[i]]), key(mesh.vertices[t[(i + 1) % 3]])}];
            for (const auto& [edge, count] : edges) {
                ASSERT_EQ(count, 1) << name_of(kind) << " " << fineness;
                ASSERT_TRUE(edges.contains({edge.second, edge.first})) << name_of(kind) << " " << fineness;
            }
        }
}

TEST(Tessellate, VolumesAreThoseOfTheSolids) {
    constexpr double pi = 3.14159265358979323846;
    EXPECT_DOUBLE_EQ(volume(tessellated(PrimitiveKind::cube, 0)), 8);
    EXPECT_NEAR(volume(tessellated(PrimitiveKind::sphere, 6)), 4 * pi / 3, 2e-3);
    EXPECT_NEAR(volume(tessellated(PrimitiveKind::cylinder, 8)), pi, 1e-4);
    EXPECT_NEAR(volume(tessellated(PrimitiveKind::cone, 8)), pi / 3, 1e-4);
    EXPECT_NEAR(volume(tessellated(PrimitiveKind::torus, 6)), 2 * pi * pi / 16, 1e-3);
}

TEST(Tessellate, NoTriangleIsDegenerateAndNormalsAreOfUnitLengthAndOutward) {
    for (const Primitive& kind : test::all_primitives()) {
        if (kind == PrimitiveKind::plane) continue;
        for (int fineness = 0; fineness <= std::min(5, max_fineness(kind)); ++fineness) {
            const auto& mesh = tessellated(kind, fineness);
            const bool flat = kind == PrimitiveKind::triangle || kind == PrimitiveKind::cube;
            ASSERT_EQ(mesh.normals.size(), flat ? 0 : mesh.vertices.size());
            std::set<std::uint32_t> used;
            for (const auto& t : mesh.triangles) {
                const Vec3 normal = face_normal(mesh, t);
                // The upper cap of a frustum may be small.
                const double size = kind == PrimitiveKind::frustum ? top_radius(kind) : 1;
                ASSERT_GT(glm::length(normal), 1e-7 * size * size) << name_of(kind) << " " << fineness;
                for (const std::uint32_t corner : t) {
                    used.insert(corner);
                    if (flat) continue;
                    ASSERT_NEAR(glm::length(mesh.normals[corner]), 1, 1e-12);
                    ASSERT_GT(glm::dot(mesh.normals[corner], normal), 0) << name_of(kind) << " " << fineness;
                }
            }
            ASSERT_EQ(used.size(), mesh.vertices.size()) << "unused vertices: " << name_of(kind);
        }
    }
}

TEST(Tessellate, StatedErrorIsReachedAndNeverExceeded) {
    constexpr int grid = 16;
    for (const Primitive& kind : curved_kinds)
        for (int fineness = 0; fineness <= 4; ++fineness) {
            const auto& mesh = tessellated(kind, fineness);
            double worst = 0;
            for (const auto& [a, b, c] : mesh.triangles)
                for (int i = 0; i <= grid; ++i)
                    for (int j = 0; i + j <= grid; ++j)
                        worst = std::max(worst, distance(kind, (double(i) * mesh.vertices[a] +
                                                                double(j) * mesh.vertices[b] +
                                                                double(grid - i - j) * mesh.vertices[c]) /
                                                                   double(grid)));
            const double stated = tessellation_error(kind, fineness);
            EXPECT_LE(worst, stated * (1 + 1e-9)) << name_of(kind) << " " << fineness;
            EXPECT_GE(worst, stated * 0.9) << name_of(kind) << " " << fineness;
        }
}

TEST(Tessellate, RimOfAPrismIsWithinTheErrorOfTheTrueRim) {
    // The other direction: points of the true rim against the polygon's sides.
    const auto& mesh = tessellated(PrimitiveKind::cylinder, 1);
    for (int i = 0; i < 360; ++i) {
        const double angle = i * 3.14159265358979323846 / 180;
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& t : mesh.triangles)
            for (int e = 0; e < 3; ++e) {
                const Vec3 a = mesh.vertices[t[e]], b = mesh.vertices[t[(e + 1) % 3]];
                if (a.y != 1 || b.y != 1) continue;
                nearest = std::min(nearest, segment_distance(std::sin(angle), std::cos(angle), {a.x, a.z, 0},
                                                             {b.x, b.z, 0}));
            }
        EXPECT_LE(nearest, tessellation_error(PrimitiveKind::cylinder, 1) * (1 + 1e-9));
    }
}

TEST(Tessellate, EachFinenessQuartersTheError) {
    for (const Primitive& kind : curved_kinds)
        for (int fineness = 2; fineness <= max_fineness(kind); ++fineness) {
            const double ratio = tessellation_error(kind, fineness - 1) / tessellation_error(kind, fineness);
            EXPECT_GT(ratio, 3) << name_of(kind) << " " << fineness;
            EXPECT_LT(ratio, 5) << name_of(kind) << " " << fineness;
        }
}

TEST(Tessellate, FinenessForIsTheLeastThatServes) {
    for (const Primitive& kind : curved_kinds) {
        EXPECT_EQ(fineness_for(kind, 10), 0);
        EXPECT_EQ(fineness_for(kind, 0), max_fineness(kind));
        EXPECT_EQ(fineness_for(kind, -1), max_fineness(kind));
        EXPECT_EQ(fineness_for(kind, std::nan("")), max_fineness(kind));
        const int fineness = fineness_for(kind, 0.003);
        EXPECT_LE(tessellation_error(kind, fineness), 0.003);
        EXPECT_GT(tessellation_error(kind, fineness - 1), 0.003);
    }
    EXPECT_EQ(fineness_for(PrimitiveKind::cube, 0), 0);
    EXPECT_EQ(tessellation_error(PrimitiveKind::cube, 0), 0);
    EXPECT_EQ(tessellation_error(PrimitiveKind::triangle, 0), 0);
}

TEST(Tessellate, CoarsestMeshesAreSmall) {
    EXPECT_EQ(tessellated(PrimitiveKind::triangle, 0).triangles.size(), 1u);
    EXPECT_EQ(tessellated(PrimitiveKind::sphere, 0).triangles.size(), 8u);
    EXPECT_EQ(tessellated(PrimitiveKind::cube, 0).triangles.size(), 12u);
    EXPECT_EQ(tessellated(PrimitiveKind::cylinder, 0).triangles.size(), 8u);
    EXPECT_EQ(tessellated(PrimitiveKind::cone, 0).triangles.size(), 4u);
    EXPECT_EQ(tessellated(PrimitiveKind::torus, 0).triangles.size(), 36u);
    EXPECT_EQ(tessellated(PrimitiveKind::sphere, 6).triangles.size(), 32768u);
}

TEST(Tessellate, StackedCubesShareWholeTriangles) {
    const auto& cube = tessellated(PrimitiveKind::cube, 0);
    std::set<std::set<Key>> all;
    for (const auto& t : cube.triangles) {
        std::set<Key> corners;
        for (const std::uint32_t corner : t)
            corners.insert(key(cube.vertices[corner]));
        all.insert(corners);
    }
    for (int axis = 0; axis < 3; ++axis)
        for (const auto& t : cube.triangles) {
            if (cube.vertices[t[0]][axis] != -1 || cube.vertices[t[1]][axis] != -1 ||
                cube.vertices[t[2]][axis] != -1)
                continue;
            std::set<Key> moved;
            for (const std::uint32_t corner : t) {
                Vec3 p = cube.vertices[corner];
                p[axis] += 2;
                moved.insert(key(p));
            }
            EXPECT_TRUE(all.contains(moved)) << "axis " << axis;
        }
}

TEST(Tessellate, MeshesAreMadeOnceWhoeverAsksFirst) {
    std::vector<std::thread> threads;
    std::vector<const TessellatedPrimitive*> seen(8);
    for (std::size_t i = 0; i < seen.size(); ++i)
        threads.emplace_back([&, i] { seen[i] = &tessellated(PrimitiveKind::torus, 3); });
    for (std::thread& thread : threads)
        thread.join();
    for (const TessellatedPrimitive* mesh : seen)
        EXPECT_EQ(mesh, seen[0]);
    EXPECT_EQ(seen[0]->triangles.size(), 36u * 64);
}

TEST(Tessellate, PlanesAndUnknownFinenessAreBugs) {
    EXPECT_BROKEN(tessellated(PrimitiveKind::plane, 0), "plane");
    EXPECT_BROKEN(tessellated(PrimitiveKind::sphere, 7), "fineness");
    EXPECT_BROKEN(tessellation_error(PrimitiveKind::cone, -1), "fineness");
}

} // namespace
} // namespace graftal
