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
        EXPECT_FALSE(sheet_of(PrimitiveKind::cylinder, turned({1, 0.06, 1}, scale)));
    }
    EXPECT_TRUE(sheet_of(PrimitiveKind::cylinder, turned({1, 0.06, 1}), true));
}

// A turtle's disc has the half axes 0.5, 0.5 and the thickness 0.001.
TEST(Sheet, IsADiscThatIsStretched) {
    for (const Vec3 size : {Vec3(1.5, 0.1, 3), Vec3(0.02, 1, 0.1414), Vec3(0.5, 0.5, 4), Vec3(1, 0.01, 1),
                            Vec3(0.0005, 1, 0.02)}) {
        const Mat3 disc = turned({0.5 * size.x, 0.001 * size.z, 0.5 * size.y});
        const auto sheet = sheet_of(PrimitiveKind::cylinder, disc);
        ASSERT_TRUE(sheet) << size.x << " " << size.y << " " << size.z;
        EXPECT_NEAR(sheet->thickness, 0.001 * size.z, 1e-12);
        EXPECT_NEAR(std::abs(glm::dot(sheet->normal, tilt.linear[1])), 1, 1e-9);
    }
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
    for (const double width : {0.1, 0.001, 1e-6}) // rods, round and half as thick as wide
        for (const double flat : {1.0, 0.5})
            EXPECT_FALSE(sheet_of(PrimitiveKind::cylinder, turned({width, 1, flat * width}))) << width;
    EXPECT_FALSE(sheet_of(PrimitiveKind::sphere, turned({0, 1, 0})));
    EXPECT_FALSE(sheet_of(PrimitiveKind::sphere, Mat3(0.0)));
    EXPECT_FALSE(sheet_of(PrimitiveKind::triangle, turned({1, 1, 0.001})));
    EXPECT_FALSE(sheet_of(PrimitiveKind::plane, turned({1, 0.001, 1})));
}

} // namespace
} // namespace graftal
