#include "compiler/povray/emit/regular_matrix.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(RegularMatrix, OrdinaryMapsComeBackUnchanged) {
    for (const double size : {1e-8, 1e-3, 1.0, 1e5}) {
        const Affine a =
            Affine::translate({1, 2, 3}) * Affine::rotate({1, 2, 3}, 40) * Affine::scale(Vec3(size));
        EXPECT_EQ(regular(a), a) << size;
    }
    const Affine sheared{Mat3(1, 0, 0, 50, 1, 0, 0, 0, -1), {0, 0, 0}};
    EXPECT_EQ(regular(sheared), sheared);
    const Affine thin = Affine::scale({100, 1e-3, 100});
    EXPECT_EQ(regular(thin), thin);
}

TEST(RegularMatrix, FlattenedAxesGetAThicknessAtRightAngles) {
    const Affine flat =
        Affine::rotate({1, 1, 0}, 30) * Affine::scale({50, 0, 20}) * Affine::rotate({0, 0, 1}, 25);
    const Affine thick = regular(flat);
    const Vec3 sigma = singular_values(thick.linear);
    EXPECT_NEAR(sigma.x, 50, 1e-9);
    EXPECT_NEAR(sigma.y, 20, 1e-9);
    EXPECT_NEAR(sigma.z, 5e-4, 1e-12);
    // What was flattened moves by the thickness, everything else stays.
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        EXPECT_LE(glm::length(thick(corner) - flat(corner)), 5e-4 * 1.8);
    }
}

TEST(RegularMatrix, LinesPointsAndNearlySingularMapsInvertToo) {
    const Affine maps[] = {Affine::scale({3, 0, 0}),
                           Affine::scale({0, 0, 0}),
                           Affine::scale({0, 0, 1e-12}),
                           Affine::scale({1, 1, 1e-30}),
                           {Mat3(1, 1, 1, 1, 1, 1, 1, 1, 1), {0, 0, 0}},
                           {Mat3(1, 2, 3, 2, 4, 6, 1, 1, 1), {0, 0, 0}},
                           {Mat3(1, 1e-17, 0, 1, 0, 1e-17, 1, 0, 0), {5, 5, 5}}};
    for (const Affine& map : maps) {
        const Affine thick = regular(map);
        const Vec3 sigma = singular_values(thick.linear);
        EXPECT_GE(sigma.z, 0.99e-9);
        EXPECT_GE(sigma.z, std::min(4.9e-4, 0.0099 * sigma.x));
        EXPECT_NEAR(sigma.x, std::max(norm(map.linear), sigma.z), 1e-12);
        EXPECT_TRUE(is_finite(inverse(thick)));
        EXPECT_EQ(thick.translation, map.translation);
    }
}

} // namespace
} // namespace graftal
