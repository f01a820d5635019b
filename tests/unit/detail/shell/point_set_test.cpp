#include "compiler/detail/shell/point_set.h"

#include <random>

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(PointPaint, LooksTheSameUpAWayAsDownIt) {
    std::mt19937 random(1);
    const auto unit = [&] { return static_cast<double>(random() % 1000) / 999; };
    std::vector<Material> materials(3);
    for (Material& material : materials)
        material.rgb = {unit(), unit(), unit()};
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<LookStep> way;
        for (int i = 0; i < 6; ++i) {
            DetailEdge edge;
            if (random() % 2) edge.tint = PathTint(Tint{{unit(), unit(), unit()}, unit()});
            if (random() % 4 == 0) edge.material = random() % materials.size();
            const MeanColour mean{0.5 * Rgb(unit(), unit(), unit()), 0.5 * unit()};
            way.push_back(look_step(edge, random() % 3 == 0 ? &mean : nullptr, materials));
        }
        Look down;
        down.inherited = {unit(), unit(), unit()};
        const Rgb inherited = down.inherited;
        PointPaint up;
        for (const LookStep& step : way)
            down.descend(step);
        for (std::size_t i = way.size(); i-- > 0;)
            up = up.above(way[i]);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(up.over(inherited)[k], down.tint.over(down.inherited)[k], 1e-6) << trial;
        EXPECT_EQ(up.material, down.material ? static_cast<std::int32_t>(*down.material) : -1) << trial;
    }
}

} // namespace
} // namespace graftal
