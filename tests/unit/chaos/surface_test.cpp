#include <numbers>

#include <gtest/gtest.h>

#include "compiler/chaos/alias_table.h"
#include "tests/unit/chaos/games.h"
#include "tests/unit/primitives/all_primitives.h"

namespace graftal {
namespace {

using std::numbers::pi;

TEST(AliasTables, ChooseByWeight) {
    AliasTables tables;
    tables.add({1, 1});
    const std::vector<double> weights = {0, 3, 0.5, 0, 5.5, 1};
    const AliasTables::Range range = tables.add(weights, 100);
    RandomStream random(1, 2);
    std::vector<double> counts(6, 0.0), shares;
    for (int i = 0; i < 1'000'000; ++i)
        ++counts.at(tables.choose(range, random.bits()) - 100);
    for (const double weight : weights)
        shares.push_back(weight / 10);
    testing::expect_by_chance(counts, shares);
}

TEST(PlacedSurface, AreasOfImages) {
    const Affine twice = Affine::scale(Vec3(2.0));
    EXPECT_NEAR(PlacedSurface(PrimitiveKind::cube, twice).area(), 96, 1e-9);
    EXPECT_NEAR(PlacedSurface(PrimitiveKind::sphere, twice).area(), 16 * pi, 1e-9);
    EXPECT_NEAR(PlacedSurface(PrimitiveKind::triangle, twice).area(), 3 * std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(PlacedSurface(PrimitiveKind::torus, Affine()).area(), pi * pi, 1e-9);
    EXPECT_NEAR(PlacedSurface(PrimitiveKind::cone, Affine()).area(), pi * (1 + std::sqrt(2.0)), 1e-9);
    // A slender cylinder, and an ellipsoid of half axes 1, 1, 2.
    const double slender = 2 * pi * (0.05 + 0.05 * 0.05);
    EXPECT_NEAR(PlacedSurface(PrimitiveKind::cylinder, Affine::scale({0.05, 1, 0.05})).area(), slender,
                0.02 * slender);
    EXPECT_NEAR(PlacedSurface(PrimitiveKind::sphere, Affine::scale({1, 2, 1})).area(), 21.4784, 0.1);
}

TEST(PlacedSurface, PointsAreEven) {
    // On a cylinder of radius 1/10 a twentieth of the points or less lies on its ends.
    const PlacedSurface cylinder(PrimitiveKind::cylinder, Affine::scale({0.1, 1, 0.1}));
    RandomStream random(1, 1);
    std::vector<double> counts(5, 0.0);
    for (int i = 0; i < 200'000; ++i) {
        const Vec3 p = cylinder.point(random);
        const bool end = p.y == 0 || p.y == 1;
        EXPECT_LE(std::hypot(p.x, p.z), 0.1 + 1e-12);
        ++counts[end ? 4 : std::min<std::size_t>(static_cast<std::size_t>(4 * p.y), 3)];
    }
    const double side = 2 * pi * 0.1, ends = 2 * pi * 0.01;
    std::vector<double> shares(4, side / 4 / (side + ends));
    shares.push_back(ends / (side + ends));
    testing::expect_by_chance(counts, shares);
}

TEST(PlacedSurface, PointsLieOnTheirPrimitives) {
    RandomStream random(3, 1);
    for (const Primitive& primitive : test::all_primitives()) {
        if (primitive == PrimitiveKind::plane || primitive.steps() % 20 > 1) continue;
        const PlacedSurface surface(primitive, Affine());
        const Box box = primitive_bounds(primitive).box;
        for (int i = 0; i < 1000; ++i) {
            const Vec3 p = surface.point(random);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(p[axis], box.min[axis] - 1e-12) << name_of(primitive);
                EXPECT_LE(p[axis], box.max[axis] + 1e-12) << name_of(primitive);
            }
            if (primitive == PrimitiveKind::torus) {
                EXPECT_NEAR(std::hypot(std::hypot(p.x, p.z) - 1, p.y), 0.25, 1e-12);
            }
        }
    }
}

} // namespace
} // namespace graftal
