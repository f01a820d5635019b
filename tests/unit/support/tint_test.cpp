#include "compiler/support/tint.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

class Tints : public testing::Test {
  protected:
    double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    Tint any() { return {{unit(), unit(), unit()}, unit()}; }

    std::mt19937_64 random_{5};
};

void expect_near(const PathTint& a, const PathTint& b) {
    EXPECT_NEAR(a.alpha, b.alpha, 4e-16);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(a.premultiplied[channel], b.premultiplied[channel], 4e-16);
}

TEST_F(Tints, AreAMonoid) {
    for (int i = 0; i < 1000; ++i) {
        const PathTint a(any()), b(any()), c(any());
        expect_near((a * b) * c, a * (b * c));
        EXPECT_EQ(a * PathTint(), a);
        EXPECT_EQ(PathTint() * a, a);
    }
}

TEST_F(Tints, DoNotCommuteTheParentIsInFront) {
    const PathTint red(Tint{{1, 0, 0}, 1});
    const PathTint blue(Tint{{0, 0, 1}, 0.5});
    EXPECT_EQ((red * blue).over(Rgb(1.0)), Rgb(1, 0, 0)) << "an opaque parent hides the rest";
    EXPECT_EQ((blue * red).over(Rgb(1.0)), Rgb(0.5, 0, 0.5));
}

TEST_F(Tints, FollowHartsEquations9And10) {
    // The paper's loop over a path, root first, in its own form: C carries colour times coverage.
    for (int i = 0; i < 200; ++i) {
        std::vector<Tint> path(1 + i % 20);
        for (Tint& tint : path)
            tint = any();
        Rgb colour(0.0);
        double alpha = 0;
        PathTint composed;
        for (const Tint& tint : path) {
            colour = colour + tint.alpha * (1 - alpha) * tint.rgb; // (9)
            alpha = alpha + tint.alpha * (1 - alpha);              // (10)
            composed = composed * PathTint(tint);
        }
        expect_near(composed, {colour, alpha});
    }
}

TEST_F(Tints, AgreeWithPaintingLayersFromTheBackInStraightColours) {
    for (int i = 0; i < 200; ++i) {
        const Rgb base(unit(), unit(), unit());
        std::vector<Tint> path(1 + i % 8);
        for (Tint& tint : path)
            tint = any();
        Rgb painted = base;
        for (auto layer = path.rbegin(); layer != path.rend(); ++layer)
            painted = layer->alpha * layer->rgb + (1 - layer->alpha) * painted;
        PathTint composed;
        for (const Tint& tint : path)
            composed = composed * PathTint(tint);
        const Rgb seen = composed.over(base);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(seen[channel], painted[channel], 1e-15);
    }
}

TEST_F(Tints, AnyCutOfAPathGivesTheSameColourTo16Bits) {
    for (int i = 0; i < 50; ++i) {
        std::vector<PathTint> path(40);
        for (PathTint& tint : path)
            tint = PathTint(any());
        PathTint whole;
        for (const PathTint& tint : path)
            whole = whole * tint;
        for (std::size_t cut = 0; cut <= path.size(); ++cut) {
            PathTint placement, mesh;
            for (std::size_t k = 0; k < cut; ++k)
                placement = placement * path[k];
            for (std::size_t k = cut; k < path.size(); ++k)
                mesh = mesh * path[k];
            const Rgb direct = whole.over(Rgb(0.8)), split = placement.over(mesh.over(Rgb(0.8)));
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(direct[channel], split[channel], 0.01 / 65535);
        }
    }
}

TEST_F(Tints, AlphaZeroChangesNothingAndOneCovers) {
    const PathTint none(Tint{{1, 1, 1}, 0});
    EXPECT_EQ(none, PathTint());
    EXPECT_EQ(none.over(Rgb(0.2, 0.3, 0.4)), Rgb(0.2, 0.3, 0.4));
    EXPECT_EQ(PathTint(Tint{{0.1, 0.2, 0.3}, 1}).over(Rgb(1.0)), Rgb(0.1, 0.2, 0.3));
}

} // namespace
} // namespace graftal
