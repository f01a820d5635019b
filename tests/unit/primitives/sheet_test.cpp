#include "compiler/primitives/sheet.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

const Affine tilt = Affine::rotate({0.3, 0.5, -0.7}, 73);

Mat3 turned(Vec3 size, double scale = 1) {
    return (Affine::scale(Vec3(scale)) * tilt * Affine::scale(size)).linear;
}

TEST(Sheet, IsAThinSolid) {
    for (const double scale : {1e-60, 1.0, 1e60}) {
        SCOPED_TRACE(scale);
        const auto disc = sheet_of(PrimitiveKind::cylinder, turned({1, 0.002, 1}, scale));
        ASSERT_TRUE(disc);
        EXPECT_NEAR(disc->thickness / scale, 0.002, 1e-12);
        EXPECT_NEAR(std::abs(glm::dot(disc->normal, tilt.linear[1])), 1, 1e-9);
        const auto ball = sheet_of(PrimitiveKind::sphere, turned({1, 2, 0.002}, scale));
        ASSERT_TRUE(ball);
        EXPECT_NEAR(ball->thickness / scale, 0.004, 1e-7);
        EXPECT_FALSE(sheet_of(PrimitiveKind::cylinder, turned({1, 0.02, 1}, scale)));
    }
    EXPECT_TRUE(sheet_of(PrimitiveKind::cylinder, turned({1, 0.02, 1}), 0.03));
}

TEST(Sheet, HasNoThicknessWhereTheMapIsSingular) {
    for (const PrimitiveKind kind :
         {PrimitiveKind::sphere, PrimitiveKind::cube, PrimitiveKind::cone, PrimitiveKind::torus}) {
        const auto sheet = sheet_of(kind, turned({1, 0, 1}));
        ASSERT_TRUE(sheet);
        EXPECT_NEAR(sheet->thickness, 0, 1e-12);
    }
}

TEST(Sheet, IsNoLineNorPointNorSurface) {
    EXPECT_FALSE(sheet_of(PrimitiveKind::cylinder, turned({0.001, 1, 0.001})));
    EXPECT_FALSE(sheet_of(PrimitiveKind::sphere, turned({0, 1, 0})));
    EXPECT_FALSE(sheet_of(PrimitiveKind::sphere, Mat3(0.0)));
    EXPECT_FALSE(sheet_of(PrimitiveKind::triangle, turned({1, 1, 0.001})));
    EXPECT_FALSE(sheet_of(PrimitiveKind::plane, turned({1, 0.001, 1})));
}

} // namespace
} // namespace graftal
