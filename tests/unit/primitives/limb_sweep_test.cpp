#include "compiler/primitives/limb_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/primitives/solid.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/primitives/triangle_mesh.h"
#include "tests/unit/primitives/sample_shapes.h"

namespace graftal {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

struct Point {
    Vec3 place;
    double radius;
};

Primitive limb(int sides, double collar, double depth, const std::vector<Point>& points) {
    std::vector<double> numbers = {double(sides), collar, depth};
    for (const auto& [place, radius] : points)
        numbers.insert(numbers.end(), {place.x, place.y, place.z, radius});
    return test::made_of(PrimitiveKind::limb_sweep, numbers);
}

const MeshData& mesh_of(const Primitive& primitive) {
    return shape_of<TriangleMesh>(primitive).data;
}

double volume_of(const MeshData& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += glm::dot(mesh.vertices[a], glm::cross(mesh.vertices[b], mesh.vertices[c])) / 6;
    return sum;
}

double frustum_volume(double length, double a, double b) {
    return pi / 3 * length * (a * a + a * b + b * b);
}

/// The number of triangles on each side, by the places of its ends.
std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, int> sides_of(const MeshData& mesh) {
    std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, int> sides;
    const auto key = [&](std::uint32_t i) {
        const Vec3& v = mesh.vertices[i];
        return std::array{v.x, v.y, v.z};
    };
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            ++sides[std::minmax(key(t[k]), key(t[(k + 1) % 3]))];
    return sides;
}

TEST(LimbSweep, AStraightLimbIsClosedAndHasTheVolumeOfItsFrusta) {
    const std::vector<Point> points = {
        {{0, 0, 0}, 0.5}, {{0, 1, 0}, 0.4}, {{0, 1.5, 0}, 0.1}, {{0, 3, 0}, 0.2}, {{0, 4, 0}, 0}};
    const double wanted = frustum_volume(1, 0.5, 0.4) + frustum_volume(0.5, 0.4, 0.1) +
                          frustum_volume(1.5, 0.1, 0.2) + frustum_volume(1, 0.2, 0);
    for (const int sides : {3, 4, 7, 16, 64}) {
        const Primitive straight = limb(sides, 0, 0, points);
        EXPECT_NEAR(volume_of(mesh_of(straight)), wanted, 1e-9) << sides;
        for (const auto& [side, count] : sides_of(mesh_of(straight)))
            EXPECT_EQ(count, 2) << sides;
        EXPECT_TRUE(encloses_volume(straight));
    }
    // Half a ball at the far end, as nearly as the sides are round.
    const Primitive round = limb(48, 0, 0, {{{0, 0, 0}, 0.3}, {{0, 2, 0}, 0.3}});
    EXPECT_NEAR(volume_of(mesh_of(round)) / (frustum_volume(2, 0.3, 0.3) + 2 * pi / 3 * 0.027), 1, 2e-3);
}

TEST(LimbSweep, RingsStrayByTheToleranceAtMost) {
    for (const double tolerance : {0.3, 0.1, 0.02, 0.01, 0.001}) {
        const int sides = limb_sides(tolerance);
        double least = INFINITY, most = 0;
        const Primitive straight = limb(sides, 0, 0, {{{0, 0, 0}, 1}, {{0, 1, 0}, 1}});
        const MeshData& mesh = mesh_of(straight);
        for (const auto& t : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 a = mesh.vertices[t[k]], b = mesh.vertices[t[(k + 1) % 3]];
                if (a.y != 1 || b.y != 1) continue;
                most = std::max(most, std::hypot(a.x, a.z));
                least = std::min(least, std::hypot(a.x + b.x, a.z + b.z) / 2);
            }
        EXPECT_LE(most, 1 + tolerance + 1e-9);
        EXPECT_GE(least, 1 - tolerance - 1e-9);
        EXPECT_NEAR(least, 1 - limb_dent(sides), 1e-9);
        if (sides > least_limb_sides) {
            EXPECT_GT(2 * std::max(most - 1, 1 - least), tolerance) << "fewer would serve";
        }
    }
}

/// A limb in the plane z = 0 that bends to and fro: the ring's beginning stays across that plane.
TEST(LimbSweep, IsNotTwistedWhereItBendsInAPlane) {
    const std::vector<Point> points = {
        {{0, 0, 0}, 0.1}, {{0, 1, 0}, 0.1}, {{1, 2, 0}, 0.1}, {{1, 3, 0}, 0.1}, {{-1, 4, 0}, 0.1}};
    const Primitive bent = limb(12, 0, 0, points);
    const MeshData& mesh = mesh_of(bent);
    std::size_t found = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& [u, v] = mesh.uv[i][k];
            if (u != 0 || v <= 0 || v > 5 / (2 * pi * 0.1)) continue;
            ++found;
            const double radius = std::sqrt((2 * pi / 12) / std::sin(2 * pi / 12)) * 0.1;
            EXPECT_NEAR(std::abs(mesh.vertices[mesh.triangles[i][k]].z), radius, 1e-9);
        }
    EXPECT_GT(found, 30u);
}

TEST(LimbSweep, PicturesRunOnByLengthAcrossItsPoints) {
    const std::vector<Point> points = {
        {{0, 0, 0}, 0.2}, {{0, 0.5, 0}, 0.2}, {{0, 2, 0}, 0.1}, {{0, 3, 0}, 0.05}};
    const Primitive straight = limb(10, 0, 0, points);
    const MeshData& mesh = mesh_of(straight);
    const double mean = (0.5 * 0.2 + 1.5 * 0.15 + 0.075) / 3;
    std::size_t found = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        double least = 1, most = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 place = mesh.vertices[mesh.triangles[i][k]];
            least = std::min(least, mesh.uv[i][k][0]);
            most = std::max(most, mesh.uv[i][k][0]);
            if (std::hypot(place.x, place.z) < 1e-9 || place.y > 3) continue;
            ++found;
            EXPECT_NEAR(mesh.uv[i][k][1], place.y / (2 * pi * mean), 1e-9);
        }
        EXPECT_LE(most - least, 0.1 + 1e-9) << "no side goes round the back";
        EXPECT_GE(least, 0);
        EXPECT_LE(most, 1);
    }
    EXPECT_GT(found, 100u);
    // The picture goes round as often as the material says, in the same proportions.
    const Vec3 point(0.2, 0.25, 0.05);
    const TexturePoint once = texture_coordinates(straight, texture_space(straight, 1, 1), point);
    const TexturePoint thrice = texture_coordinates(straight, texture_space(straight, 3, 1), point);
    EXPECT_NEAR(once[1], 0.25 / (2 * pi * mean), 1e-3);
    EXPECT_NEAR(thrice[0], 3 * once[0], 1e-12);
    EXPECT_NEAR(thrice[1], 3 * once[1], 1e-12);
}

/// Collars are sunk in the limb that they leave, and narrow to their own.
TEST(LimbSweep, ACollarWidensItsBaseSmoothly) {
    const double own = 0.1, collar = 0.18, depth = 0.3;
    const Primitive with = limb(24, collar, depth, {{{0, 0, 0}, own}, {{0, 2, 0}, own}});
    EXPECT_TRUE(encloses_volume(with));
    const double growth = std::sqrt((2 * pi / 24) / std::sin(2 * pi / 24));
    double last = INFINITY, last_y = 0;
    std::map<double, double> radius_at;
    for (const Vec3& v : mesh_of(with).vertices)
        if (v.y >= 0 && v.y <= 2) radius_at[v.y] = std::max(radius_at[v.y], std::hypot(v.x, v.z) / growth);
    for (const auto& [y, radius] : radius_at) {
        EXPECT_LE(radius, last + 1e-9) << y;
        EXPECT_LE(last == INFINITY ? 0 : last - radius, (y - last_y) + 1e-9) << "steeper than 45 degrees";
        if (y <= depth) {
            EXPECT_NEAR(radius, collar, 1e-9) << y;
        }
        if (y >= depth + 2.5 * collar) {
            EXPECT_NEAR(radius, own, 1e-9) << y;
        }
        last = radius, last_y = y;
    }
    EXPECT_GE(radius_at.size(), 6u);
    for (const Vec3& v : mesh_of(with).vertices)
        if (v.y < 0) {
            EXPECT_LE(glm::length(v), growth * collar + 1e-9);
        }
    // A collar that is no wider than the limb is a round end.
    EXPECT_NEAR(traits_of(with).box(limb(24, own, 0, {{{0, 0, 0}, own}, {{0, 2, 0}, own}})).min.y,
                -growth * own, 1e-9);
}

TEST(LimbSweep, IsClosedWhateverItsPoints) {
    std::mt19937_64 random(11);
    const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    const auto below = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
    for (int i = 0; i < 300; ++i) {
        std::vector<Point> points = {{{unit(), unit(), unit()}, std::abs(unit())}};
        const int count = 1 + below(12);
        for (int k = 0; k < count; ++k) {
            Vec3 step(unit(), unit(), unit());
            switch (below(5)) {
            case 0: // along an axis, so that bends are of right angles, or turn back
                step = Vec3(0.0);
                step[below(3)] = below(2) ? 1 : -1;
                break;
            case 1: // much shorter than the limb is thick
                step *= 1e-4;
                break;
            default:
                break;
            }
            const double radius = below(4) == 0 ? 0 : std::pow(10.0, -4 * std::abs(unit()));
            points.push_back({points.back().place + step, radius});
        }
        const bool has_collar = below(2) == 0;
        const Primitive some =
            limb(3 + below(20), has_collar ? std::abs(unit()) : 0, has_collar ? std::abs(unit()) : 0, points);
        EXPECT_TRUE(encloses_volume(some)) << name_of(some);
        const MeshData& mesh = mesh_of(some);
        for (const Vec3& vertex : mesh.vertices)
            EXPECT_TRUE(std::isfinite(glm::length(vertex)));
        for (const auto& corners : mesh.uv)
            for (const auto& [u, v] : corners)
                EXPECT_TRUE(std::isfinite(u) && std::isfinite(v));
        EXPECT_LT(mesh.triangles.size(), 12u * 22 * 2 * 22);
    }
}

TEST(LimbSweep, RefusesWhatIsNoLimb) {
    const auto fault = [](const std::vector<double>& numbers) {
        std::string said;
        EXPECT_FALSE(traits_of(PrimitiveKind::limb_sweep).make(numbers, said));
        return said;
    };
    EXPECT_THAT(fault({2, 0, 0, 0, 0, 0, 1, 0, 1, 0, 1}), HasSubstr("from 3 to 64 sides, not 2"));
    EXPECT_THAT(fault({4.5, 0, 0, 0, 0, 0, 1, 0, 1, 0, 1}), HasSubstr("sides, not 4.5"));
    EXPECT_THAT(fault({4, 0, 0, 0, 0, 0, 1, 0, 1, 0, 1, 5}), HasSubstr("four numbers for each point"));
    EXPECT_THAT(fault({4, -1, 0, 0, 0, 0, 1, 0, 1, 0, 1}), HasSubstr("between 0 and 1000, not -1"));
    EXPECT_THAT(fault({4, 0, 0, 0, 0, 0, 1, 0, 1e9, 0, 1}), HasSubstr("not 1e+09"));
    EXPECT_THAT(fault({4, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1}), HasSubstr("are the same"));
    EXPECT_THAT(fault({4, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}), HasSubstr("has no surface"));
}

} // namespace
} // namespace graftal
