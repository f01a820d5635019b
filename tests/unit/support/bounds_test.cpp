#include "compiler/support/bounds.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

constexpr double root_half = 0.70710678118654752440;

TEST(Box, TheDefaultIsEmptyAndGrows) {
    Box box;
    EXPECT_TRUE(box.empty());
    box.include(Box());
    EXPECT_TRUE(box.empty());
    box.include(Vec3(1, 2, 3));
    EXPECT_FALSE(box.empty()) << "a point is not empty";
    EXPECT_EQ(box.size(), Vec3(0.0));
    box.include(Vec3(-1, 5, 3));
    EXPECT_EQ(box, (Box{{-1, 2, 3}, {1, 5, 3}}));
    EXPECT_EQ(box.centre(), Vec3(0, 3.5, 3));
    const Box before = box;
    box.include(Box());
    EXPECT_EQ(box, before);
}

TEST(Box, NotANumberIsEmpty) {
    EXPECT_TRUE((Box{Vec3(std::nan("")), Vec3(1.0)}.empty()));
}

TEST(Box, TransformedIsTheBoxOfTheCorners) {
    const Box unit{Vec3(-1.0), Vec3(1.0)};
    const Box turned = transformed(Affine::rotate({0, 0, 1}, 45), unit);
    EXPECT_NEAR(turned.max.x, 2 * root_half, 1e-15);
    EXPECT_NEAR(turned.min.y, -2 * root_half, 1e-15);
    EXPECT_EQ(turned.max.z, 1);
    EXPECT_EQ(transformed(Affine::rotate({0, 0, 1}, 90), Box{{0, 0, 0}, {1, 2, 3}}),
              (Box{{-2, 0, 0}, {0, 1, 3}}));
    EXPECT_EQ(transformed(Affine::scale({-1, 2, 0}), Box{{1, 1, 1}, {2, 2, 2}}),
              (Box{{-2, 2, 0}, {-1, 4, 0}}));
    EXPECT_TRUE(transformed(Affine::translate({1, 0, 0}), Box()).empty());
}

TEST(Ball, TransformedGrowsByTheLargestStretch) {
    const Ball ball{{1, 0, 0}, 2};
    EXPECT_EQ(transformed(Affine::scale({-1, 3, 0.5}), ball), (Ball{{-1, 0, 0}, 6}));
    EXPECT_TRUE(transformed(Affine::scale(Vec3(2.0)), Ball()).empty());
    EXPECT_FALSE((Ball{{0, 0, 0}, 0}.empty())) << "a point is not empty";
}

TEST(Bounds, TransformedBoundsHoldTransformedPoints) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> entry(-2, 2);
    for (int i = 0; i < 200; ++i) {
        Affine a;
        for (int k = 0; k < 9; ++k)
            a.linear[k / 3][k % 3] = entry(random);
        a.translation = {entry(random), entry(random), entry(random)};
        const Box box = transformed(a, Box{Vec3(-1.0), Vec3(1.0)});
        const Ball ball = transformed(a, Ball{Vec3(0.0), 1});
        for (int k = 0; k < 20; ++k) {
            const Vec3 p = 0.5 * Vec3(entry(random), entry(random), entry(random));
            const Vec3 q = a(p);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(box.min[axis], q[axis] + 1e-14);
                EXPECT_GE(box.max[axis], q[axis] - 1e-14);
            }
            EXPECT_LE(glm::length(a(glm::normalize(p)) - ball.centre), ball.radius + 1e-14);
        }
    }
}

} // namespace
} // namespace graftal
