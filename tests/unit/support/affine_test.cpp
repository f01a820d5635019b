#include "compiler/support/affine.h"
#include "tests/unit/broken_invariant.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

/// Row by row, as on paper.
Mat3 rows(double a, double b, double c, double d, double e, double f, double g, double h, double i) {
    return Mat3(a, d, g, b, e, h, c, f, i);
}

void expect_singular_values(const Mat3& linear, Vec3 expected, double tolerance = 4e-16) {
    const Vec3 sigma = singular_values(linear);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(sigma[i], expected[i], tolerance * expected[0]) << "singular value " << i;
}

Affine random_affine(std::mt19937_64& random) {
    std::uniform_real_distribution<double> entry(-2, 2);
    Affine a;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            a.linear[column][row] = entry(random);
    a.translation = {entry(random), entry(random), entry(random)};
    return a;
}

TEST(Affine, ProductsReadFromTheRight) {
    const Affine scale = Affine::scale({2, 2, 2});
    const Affine move = Affine::translate({1, 0, 0});
    EXPECT_EQ((move * scale)(Vec3(1, 1, 1)), Vec3(3, 2, 2)) << "scaled first, then moved";
    EXPECT_EQ((scale * move)(Vec3(1, 1, 1)), Vec3(4, 2, 2)) << "moved first, then scaled";
}

TEST(Affine, RotationIsRightHanded) {
    const auto turn = [](Vec3 axis, Vec3 v) { return Affine::rotate(axis, 90)(v); };
    EXPECT_EQ(turn({1, 0, 0}, {0, 1, 0}), Vec3(0, 0, 1));
    EXPECT_EQ(turn({0, 1, 0}, {0, 0, 1}), Vec3(1, 0, 0));
    EXPECT_EQ(turn({0, 0, 1}, {1, 0, 0}), Vec3(0, 1, 0));
}

TEST(Affine, QuarterTurnsAreExactHoweverManyTurnsOn) {
    for (const double quarter : {-7, -3, -2, -1, 0, 1, 2, 3, 4, 400001}) {
        const Mat3 m = Affine::rotate({0, 0, 5}, 90 * quarter).linear;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                EXPECT_EQ(m[column][row], std::round(m[column][row])) << quarter << " quarters";
        EXPECT_EQ(glm::determinant(m), 1);
    }
}

TEST(Affine, RotationAboutAnyAxisKeepsItAndLengths) {
    const Vec3 axis(1, -2, 0.5);
    const Affine r = Affine::rotate(axis, 37);
    EXPECT_LT(glm::length(r(axis) - axis), 1e-15 * 4);
    const Vec3 v(0.3, 4, -1);
    EXPECT_NEAR(glm::length(r(v)), glm::length(v), 1e-14);
    const Vec3 back = Affine::rotate(axis, -37)(r(v));
    EXPECT_LT(glm::length(back - v), 1e-14);
    EXPECT_LT(glm::length(Affine::rotate(Vec3(1, 1, 1), 120)(Vec3(1, 2, 3)) - Vec3(3, 1, 2)), 1e-15 * 8);
}

TEST(Affine, InverseUndoes) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100; ++i) {
        const Affine a = random_affine(random);
        if (is_singular(a, 1e-2)) continue;
        const Vec3 p(1, -2, 3);
        EXPECT_LT(glm::length((inverse(a) * a)(p)-p), 1e-11);
        EXPECT_LT(glm::length((a * inverse(a))(p)-p), 1e-11);
    }
}

TEST(SingularValues, ClosedCases) {
    expect_singular_values(Mat3(1.0), {1, 1, 1});
    expect_singular_values(rows(0, 0, 3, -1, 0, 0, 0, 2, 0), {3, 2, 1});
    // A shear by 1 stretches by the golden ratio.
    const double golden = std::numbers::phi;
    expect_singular_values(rows(1, 1, 0, 0, 1, 0, 0, 0, 1), {golden, 1, 1 / golden});
    expect_singular_values(rows(1, 1, 1, 1, 1, 1, 1, 1, 1), {3, 0, 0});
    expect_singular_values(rows(1, 2, 0, 2, 4, 0, 0, 0, 0), {5, 0, 0});
    expect_singular_values(Mat3(0.0), {0, 0, 0});
}

TEST(SingularValues, RotationsOnBothSidesChangeNothing) {
    const Mat3 left = Affine::rotate({1, 2, 3}, 41).linear;
    const Mat3 right = Affine::rotate({-3, 1, 1}, 113).linear;
    for (const Vec3 sigma : {Vec3(5, 3, 1), Vec3(1, 1, 1e-9), Vec3(1, 1e-13, 1e-13), Vec3(2, 2, 2)})
        expect_singular_values(left * Affine::scale(sigma).linear * right, sigma, 2e-15);
}

TEST(SingularValues, NeitherOverflowNorUnderflow) {
    for (const double size : {1e-300, 1e-200, 1e-30, 1e30, 1e200, 1e300}) {
        const Mat3 shear = size * rows(1, 1, 0, 0, 1, 0, 0, 0, 1);
        expect_singular_values(shear, size * Vec3(std::numbers::phi, 1, 1 / std::numbers::phi));
        EXPECT_FALSE(is_singular(Affine{shear, Vec3(0.0)})) << size;
    }
    const double least = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(singular_values(least * Mat3(1.0)), Vec3(least));
}

TEST(SingularValues, ProductIsTheDeterminantAndSquaresSumToTheEntries) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 1000; ++i) {
        const Mat3 m = random_affine(random).linear;
        const Vec3 sigma = singular_values(m);
        EXPECT_GE(sigma.x, sigma.y);
        EXPECT_GE(sigma.y, sigma.z);
        EXPECT_NEAR(sigma.x * sigma.y * sigma.z, std::abs(glm::determinant(m)), 1e-13 * std::pow(sigma.x, 3));
        const double squares = glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
        EXPECT_NEAR(glm::dot(sigma, sigma), squares, 1e-14 * squares);
        EXPECT_EQ(norm(m), sigma.x);
    }
}

TEST(Affine, SingularIsRelative) {
    EXPECT_FALSE(is_singular(Affine::scale(Vec3(1e-30))));
    EXPECT_FALSE(is_singular(Affine::scale({1, 1, 1e-11})));
    EXPECT_TRUE(is_singular(Affine::scale({1, 1, 1e-13})));
    EXPECT_TRUE(is_singular(Affine::scale({1, 1, 0})));
    EXPECT_TRUE(is_singular(Affine::scale(Vec3(0.0))));
}

TEST(Affine, FiniteLooksAtEveryEntry) {
    EXPECT_TRUE(is_finite(Affine()));
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        for (int entry = 0; entry < 12; ++entry) {
            Affine a;
            (entry < 9 ? a.linear[entry / 3][entry % 3] : a.translation[entry - 9]) = bad;
            EXPECT_FALSE(is_finite(a)) << entry;
        }
    }
}

TEST(Affine, AZeroAxisIsABug) {
    EXPECT_BROKEN(Affine::rotate(Vec3(0.0), 30), "rotation about a zero axis");
}

} // namespace
} // namespace graftal
