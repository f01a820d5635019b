#include "runtime/inverse/colours.h"

#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

constexpr int size = 160;
const PlaneMaps tinted_gasket = {
    {0.5, 0, 0, 0.5, 0, 0}, {0.5, 0, 0, 0.5, 0.5, 0}, {0.5, 0, 0, 0.5, 0.25, 0.5}};

/// The gasket by random iteration, each point in the colour of its address.
struct Coloured {
    CellSet set{size, size};
    std::vector<Rgb> colours = std::vector<Rgb>(size * size, Rgb(0.0));

    Coloured(const std::vector<Rgb>& tints, double alpha) {
        Draws draws(CounterRandom(4), 0);
        Vec2 p{0, 0};
        Rgb colour(0.5);
        for (int i = 0; i < 300'000; ++i) {
            const std::size_t m = draws.below(tinted_gasket.size());
            p = tinted_gasket[m](p);
            colour = alpha * tints[m] + (1 - alpha) * colour;
            const std::size_t cell = set.index(static_cast<int>(p.x * size), static_cast<int>(p.y * size));
            set.cells[cell] = true;
            colours[cell] = colour;
        }
    }
};

SystemColours fitted(const Coloured& picture) {
    const Target target(picture.set);
    PlaneMaps maps = tinted_gasket;
    const double room = target.room();
    for (PlaneMap& map : maps) { // from the unit square into the target's cells
        map.e = size * map.e + room - map.a * room - map.b * room;
        map.f = size * map.f + room - map.c * room - map.d * room;
    }
    std::vector<Rgb> colours;
    for (const Vec2 p : target.points())
        colours.push_back(
            picture.colours[picture.set.index(static_cast<int>(p.x - room), static_cast<int>(p.y - room))]);
    return fit_colours(target, maps, colours);
}

TEST(SystemColours, AreFoundAgainFromThePointsThatShowThem) {
    const std::vector<Rgb> tints = {{0.9, 0.1, 0.2}, {0.1, 0.7, 0.3}, {0.05, 0.2, 0.8}};
    for (const double alpha : {1.0, 0.65, 0.35}) {
        const SystemColours found = fitted({tints, alpha});
        EXPECT_EQ(found.alpha, alpha);
        EXPECT_LT(found.rms_255, 6) << alpha;
        ASSERT_EQ(found.of_map.size(), tints.size());
        for (std::size_t m = 0; m < tints.size(); ++m)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found.of_map[m][c], tints[m][c], 0.03) << alpha << " " << m;
    }
}

TEST(SystemColours, OneColourNeedsNoMore) {
    const SystemColours found = fitted({std::vector<Rgb>(3, Rgb(0.2, 0.6, 0.4)), 0.5});
    EXPECT_LT(found.rms_255, 1);
    for (const Rgb& rgb : found.of_map)
        EXPECT_NEAR(rgb.g, 0.6, 0.02);
}

} // namespace
} // namespace graftal
