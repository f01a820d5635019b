#include <gtest/gtest.h>

#include "compiler/graph/path.h"

namespace graftal {
namespace {

struct Edge {
    PathTint tint;
    std::optional<MaterialId> material;
};

const std::vector<Material> materials = [] {
    std::vector<Material> made(2);
    made[0].rgb = {1, 0.5, 0};
    made[1].rgb = {0, 0.25, 1};
    return made;
}();

Look after(const std::vector<LookStep>& way) {
    Look look;
    for (const LookStep& step : way)
        look.descend(step);
    return look;
}

TEST(Look, TheNearestMaterialGivesItsColour) {
    const Look plain = after({look_step(Edge{}, nullptr, materials)});
    EXPECT_EQ(plain.inherited, Material{}.rgb);
    EXPECT_FALSE(plain.material);
    const Look look =
        after({look_step(Edge{{}, 0}, nullptr, materials), look_step(Edge{}, nullptr, materials)});
    EXPECT_EQ(look.inherited, Rgb(1, 0.5, 0));
    EXPECT_EQ(look.material, 0u);
    EXPECT_EQ(after({look_step(Edge{{}, 0}, nullptr, materials), look_step(Edge{{}, 1}, nullptr, materials)})
                  .material,
              1u);
}

TEST(Look, TintsNearerToTheRootStayInFront) {
    const PathTint red(Tint{{1, 0, 0}, 0.5}), blue(Tint{{0, 0, 1}, 0.5});
    const Look look =
        after({look_step(Edge{red, 0}, nullptr, materials), look_step(Edge{blue, {}}, nullptr, materials)});
    EXPECT_EQ(look.tint.over(look.inherited), Rgb(0.5 + 0.25, 0.125, 0.25));
}

TEST(Look, AStandInTakesOnTheMeanColour) {
    const MeanColour mean{{0.25, 0, 0}, 0.5};
    const Look look =
        after({look_step(Edge{{}, 0}, nullptr, materials), look_step(Edge{}, &mean, materials)});
    EXPECT_EQ(look.inherited, Rgb(0.75, 0.25, 0));
    EXPECT_EQ(look.material, 0u) << "the finish is inherited";
    const Look own = after({look_step(Edge{{}, 1}, &mean, materials)});
    EXPECT_EQ(own.inherited, Rgb(0, 0.25, 1)) << "a stand-in keeps the material that it names";
}

TEST(Paint, LiesBehindThatOfTheEdgesAbove) {
    const Paint front(PathTint(Tint{{1, 0, 0}, 0.5})), back(PathTint(Tint{{0, 0, 1}, 0.75}));
    const Paint both = back.under(front);
    EXPECT_EQ(both.fixed, (std::array<float, 3>{0.5f, 0, 0.375f}));
    EXPECT_EQ(both.open, 0.125f);
}

TEST(StraightTint, IsTheTintOfThePathWithinItsRange) {
    const Tint half{{1, 0.25, 0}, 0.5};
    EXPECT_EQ(straight(PathTint(half)), half);
    EXPECT_EQ(straight(PathTint(Tint{{1, 1, 1}, 0})), Tint());
    EXPECT_EQ(straight(PathTint(half) * PathTint(Tint{{1, 0.25, 1}, 1})), (Tint{{1, 0.25, 0.5}, 1}));
    const Tint most = straight(PathTint(Rgb(0.3 + 1e-16, 0.1, 0), 0.3));
    EXPECT_LE(most.rgb.r, 1);
}

} // namespace
} // namespace graftal
