// The light on plants against closed forms.

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "compiler/support/counter_random.h"
#include "tests/unit/plants/plants.h"

namespace graftal {
namespace {

using test::lit;
using test::LitPlant;
using test::plant_text;
using test::square;

constexpr double pi = std::numbers::pi;
const std::string black = "material leaf { color: 0,0,0  diffuse: 0 }\n";
const std::string green = "material leaf { color: 0.5,0.5,0.5  diffuse: 0.4  translucency: 0.2 }\n";
const std::string level_square = "axiom &(90)" + square(1);

TEST(PlantLight, OnALevelLeafUnderAnEvenSky) {
    const LitPlant leaf = lit(plant_text(green, level_square), 1024);
    ASSERT_TRUE(leaf.light) << leaf.messages;
    EXPECT_NEAR(leaf.at(0), 1, 1e-6);
    EXPECT_NEAR(static_cast<double>(leaf.light->organs[0].absorbed), 0.7, 1e-6);
    EXPECT_NEAR(leaf.light->falls.amount, 1, 1e-6);
    EXPECT_NEAR(leaf.light->taken, 0.7, 1e-6);
    EXPECT_NEAR(leaf.light->to_sky, 0.2, 0.002);
    EXPECT_NEAR(leaf.light->to_ground, 0.1, 0.002);
    EXPECT_FALSE(leaf.light->has_sun);
    const LitPlant upright = lit(plant_text(green, "axiom " + square(1)), 1024);
    EXPECT_NEAR(upright.at(0), 1, 0.01) << "each side sees half of the sky";
}

// A sky of which the brightness is linear in the height: integrals over the half sphere by hand.
TEST(PlantLight, IsOverThatOfOpenGround) {
    const LitPlant leaf = lit(
        plant_text(green + "sky { zenith: 3,2,1  horizon: 0.5,1,2  below: 9,9,9 }\n", level_square), 4096);
    ASSERT_TRUE(leaf.light) << leaf.messages;
    EXPECT_NEAR(leaf.at(0), 1, 0.01);
    EXPECT_LT(leaf.error(0), 0.01);
}

TEST(PlantLight, OfASun) {
    const std::string sun = "light { sun: 1,2,0 }\n";
    EXPECT_NEAR(lit(plant_text(black + sun, level_square), 16).at(0), 1, 1e-6);
    // The square in the plane z = 0 is seen edge-on; turned about the vertical, it faces the sun's azimuth.
    EXPECT_NEAR(lit(plant_text(black + sun, "axiom /(90)" + square(1)), 16).at(0), 0.5, 1e-6);
    const LitPlant tilted = lit(plant_text(black + sun, "axiom /(90)&(30)" + square(1)), 16);
    const Vec3 normal = tilted.plant->modules[0].up;
    EXPECT_NEAR(tilted.at(0), std::abs(normal.x + 2 * normal.y) / 2, 1e-6);
    const LitPlant wide = lit(plant_text(black + "light { sun: 1,2,0  angle: 5 }\n", level_square), 1024);
    EXPECT_NEAR(wide.at(0), 1, 0.01);
    EXPECT_NEAR(wide.light->sunlit_leaf_area, 1, 1e-6);
    EXPECT_FALSE(lit(plant_text(black + "light { sun: 1,-2,0 }\n", level_square), 16).light);
    const std::string fill = "light { sun: -1,2,0  shadowless }\n";
    EXPECT_NEAR(lit(plant_text(black + sun + fill, "axiom /(90)" + square(1)), 16).at(0), 0.5, 1e-6);
    const LitPlant filled = lit(plant_text(black + fill, level_square), 16);
    EXPECT_FALSE(filled.light);
    EXPECT_NE(filled.messages.find("no sun that casts shadows"), std::string::npos) << filled.messages;
}

TEST(PlantLight, OnRoundOrgans) {
    EXPECT_NEAR(lit(plant_text("", "axiom F(1)"), 4096).at(0), 0.5, 0.005) << "a wall sees half of the sky";
    EXPECT_NEAR(lit(plant_text("", "axiom @O(1)"), 16384).at(0), 0.5, 0.005);
    const std::string sun = "light { sun: 1,1,0 }\n";
    // A lit cylinder has the mean cosine 1/pi of a circle; the sun falls on it at 45 degrees.
    EXPECT_NEAR(lit(plant_text(sun, "axiom F(1)"), 4096).at(0), 1 / pi, 0.004);
    EXPECT_NEAR(lit(plant_text(sun, "axiom @O(1)"), 4096).at(0), 0.25 * std::numbers::sqrt2, 0.004);
}

/// The share of the rays from a square that reach an equal one opposite (Howell, "A catalog of radiation heat
/// transfer configuration factors", C-11). `x`: side over distance.
double view_factor(double x) {
    const double root = std::sqrt(1 + x * x);
    return 2 / (pi * x * x) *
           (std::log((1 + x * x) / std::sqrt(1 + 2 * x * x)) + 2 * x * root * std::atan(x / root) -
            2 * x * std::atan(x));
}

TEST(PlantLight, OnALeafBelowAnother) {
    EXPECT_NEAR(view_factor(1), 0.19982, 1e-5);
    for (const double distance : {0.5, 1.0, 3.0}) {
        const std::string pair = fmt::format("axiom [f(1)&(90){0}][f({1})&(90){0}]", square(1), 1 + distance);
        const LitPlant dark = lit(plant_text(black, pair), 4096);
        ASSERT_TRUE(dark.light) << dark.messages;
        EXPECT_NEAR(dark.at(0), 1 - view_factor(1 / distance), 0.01);
        EXPECT_NEAR(dark.at(1), 1, 1e-6);
        // Once more between them: what each scatters to the other is in its light.
        const LitPlant bright = lit(plant_text(green, pair), 4096);
        EXPECT_GT(bright.at(0), dark.at(0) + 0.01 * view_factor(1 / distance));
        EXPECT_GT(bright.at(1), 1);
    }
}

/// A layer of random small leaves, squares, in a box of 10 x 2 x 10; each is level, or turned at random.
std::string layer(int count, double side, bool level) {
    const CounterRandom random(7);
    std::uint64_t drawn = 0;
    const auto number = [&] { return CounterRandom::unit(random(drawn++)); };
    std::string word = "axiom ["; // lines go on in a bracket
    for (int i = 0; i < count; ++i) {
        const double x = 10 * number(), y = 2 * number(), z = 10 * number();
        word += fmt::format("[@M({:.5f},{:.5f},{:.5f})", x, 1 + y, z);
        if (level) {
            word += fmt::format("@R(1,0,0,0,1,0)+({:.3f})", 360 * number());
        } else { // the normal is as likely in all directions
            const double up = 2 * number() - 1, turn = 2 * pi * number(), across = std::sqrt(1 - up * up);
            word += fmt::format("@R({:.5f},{:.5f},{:.5f})/({:.3f})+(90)", across * std::cos(turn), up,
                                across * std::sin(turn), 360 * number());
        }
        word += square(side) + "]";
        if (i % 20 == 19) word += "\n  ";
    }
    return word + "]";
}

// Beer and Lambert: of light from overhead, exp(-G L) comes through random leaves of area L over the ground.
TEST(PlantLight, ThroughATurbidLayer) {
    constexpr int count = 5000;
    constexpr double side = 0.2, area_index = count * side * side / 100;
    for (const bool level : {true, false}) {
        const double g = level ? 1 : 0.5;
        const LitPlant leaves =
            lit(plant_text(black + "light { sun: 0,1,0 }\n", layer(count, side, level)), 32);
        ASSERT_TRUE(leaves.light) << leaves.messages;
        EXPECT_EQ(leaves.light->lit_organs, static_cast<std::uint64_t>(count));
        // The leaves at the edge hang over it: a hundredth of the layer or so.
        EXPECT_NEAR(leaves.light->falls.amount / 100, 1 - std::exp(-g * area_index), 0.02) << level;
        if (level) {
            EXPECT_NEAR(leaves.light->sunlit_leaf_area / 100, 1 - std::exp(-area_index), 0.02);
        }
        EXPECT_NEAR(leaves.light->sunlit_leaf_area + leaves.light->shaded_leaf_area, 100 * area_index, 1e-6);
    }
}

TEST(PlantLight, GoesSomewhere) {
    const std::string light =
        "sky { zenith: 1,1,1  horizon: 0.5,0.5,0.5 }\nlight { sun: 1,2,1  angle: 0.5 }\n";
    const LitPlant leaves = lit(plant_text(green + light, layer(1500, 0.3, false)), 64);
    ASSERT_TRUE(leaves.light) << leaves.messages;
    const PlantLight& found = *leaves.light;
    EXPECT_NEAR(found.taken + found.to_sky + found.to_ground + found.left, found.falls.amount,
                1e-9 * found.falls.amount);
    EXPECT_LT(found.left, 1e-3 * found.falls.amount);
    // Both ways to find what is taken: looking from each organ, and following the light.
    EXPECT_NEAR(found.absorbed.amount, found.taken, 0.01 * found.taken);
    EXPECT_LT(found.absorbed.error, 0.01 * found.taken);
    EXPECT_GT(found.absorbed.amount, 0.7 * found.falls.amount) << "some is taken after it was scattered";
}

// A disc is a thin solid, and one leaf: light that meets it goes on from it once, as from a square.
TEST(PlantLight, OfDiscsIsThatOfLeaves) {
    const std::string clear = "material leaf { color: 1,1,1  diffuse: 0  translucency: 0.5  specular: 0 }\n";
    const LitPlant discs = lit(plant_text(clear, "axiom [&(90)@o(2)][f(1)&(90)@o(2)]"), 16384);
    ASSERT_TRUE(discs.light) << discs.messages;
    const PlantLight& found = *discs.light;
    // Discs of radius 1 and as far apart (Howell, C-41). Half of what comes to the upper one goes through it,
    // and of that this share comes to the lower one, in the place of light of the sky.
    const double factor = (3 - std::sqrt(5.0)) / 2;
    EXPECT_NEAR(found.falls.amount, pi * (2 - factor), 0.02);
    EXPECT_NEAR(found.absorbed.amount, pi / 2 * (2 - factor / 2), 0.01);
    EXPECT_NEAR(found.taken, pi / 2 * (2 - factor / 2), 0.02);
}

// Discs of diameter 2 that are nearer than they are thick.
TEST(PlantLight, OfOneDiscUponAnother) {
    for (const double distance : {0.01, 0.001, 1e-4}) {
        const LitPlant discs =
            lit(plant_text(black, fmt::format("axiom [&(90)@o(2)][f({})&(90)@o(2)]", distance)), 64);
        ASSERT_TRUE(discs.light) << discs.messages;
        EXPECT_NEAR(discs.at(0), 0, 0.02) << distance;
        EXPECT_NEAR(discs.at(1), 1, 0.02) << distance;
    }
}

// Discs that a word draws here and there, all over a cube.
TEST(PlantLight, TakesWorkByTheNumberOfOrgans) {
    const auto work_of_ray = [&](int steps) {
        const std::string place = "@M(random(0,1),random(0,1),random(0,1))/(random(0,360))&(random(0,180))";
        const std::string disc = fmt::format("[{}@o({})]", place, 0.5 * std::pow(2, -steps / 3.0));
        const LitPlant discs = lit(
            fmt::format("lsys a {{\n steps {}\n axiom A\n A -> AA\n interpret A -> {}\n}}\n", steps, disc), 4,
            1, 1000, true);
        EXPECT_TRUE(discs.light) << discs.messages;
        return discs.light->work_seconds / static_cast<double>(discs.light->rays);
    };
    EXPECT_LT(work_of_ray(14), 1.5 * work_of_ray(12)) << "four times as many discs";
}

TEST(PlantLight, KnowsNoShareInTheSunWithoutASun) {
    const LitPlant shaded = lit(plant_text(green, level_square), 16);
    ASSERT_TRUE(shaded.light) << shaded.messages;
    EXPECT_TRUE(std::isnan(shaded.light->organs[0].sunlit));
    const LitPlant sunny = lit(plant_text(green + "light { sun: 0,1,0 }\n", level_square), 16);
    ASSERT_TRUE(sunny.light) << sunny.messages;
    EXPECT_EQ(sunny.light->organs[0].sunlit, 1);
}

TEST(PlantLight, IsTheSameForAnyThreads) {
    const std::string text = plant_text(green, layer(300, 0.3, false));
    const LitPlant one = lit(text, 16, 1), three = lit(text, 16, 3);
    ASSERT_TRUE(one.light && three.light);
    EXPECT_EQ(one.light->rays, three.light->rays);
    EXPECT_EQ(one.light->absorbed.amount, three.light->absorbed.amount);
    EXPECT_EQ(one.light->work_seconds, three.light->work_seconds);
    for (std::size_t i = 0; i < one.plant->modules.size(); ++i)
        EXPECT_EQ(one.light->organs[i].light, three.light->organs[i].light);
}

// Discs of radius 0.8 and 1.3, at a distance of 0.9 (Howell, C-41): sides of the lower one see the upper one.
TEST(PlantLight, TakesSamplesUntilTheErrorIsSmall) {
    const std::string pair = "axiom [&(90)@o(1.6)][@M(0,0.9,0)&(90)@o(2.6)]";
    const LitPlant discs = lit(plant_text(black, pair), std::nullopt);
    ASSERT_TRUE(discs.light) << discs.messages;
    const double lower = 0.8 / 0.9, upper = 1.3 / 0.9, x = 1 + (1 + upper * upper) / (lower * lower);
    const double factor = (x - std::sqrt(x * x - 4 * std::pow(upper / lower, 2))) / 2;
    EXPECT_NEAR(discs.at(0), 1 - factor, 0.01);
    EXPECT_NEAR(discs.at(1), 1, 1e-6);
    const double error = std::sqrt((std::pow(discs.error(0), 2) + std::pow(discs.error(1), 2)) / 2);
    EXPECT_LE(error, 0.01 * (discs.at(0) + discs.at(1)) / 2);
    EXPECT_GT(discs.light->samples, 64);
    EXPECT_LT(discs.light->work_seconds, 10);
    const LitPlant asked = lit(plant_text(black, pair), 64), sure = lit(plant_text(black, level_square), {});
    ASSERT_TRUE(asked.light && sure.light);
    EXPECT_EQ(asked.light->samples, 64) << "so many were asked for";
    EXPECT_EQ(sure.light->samples, 64) << "no sample differs from another";
    // The work ends it, too, and the same work always at the same samples.
    const double work_seconds = 0.4 * discs.light->work_seconds;
    const LitPlant less = lit(plant_text(black, pair), {}, 1, work_seconds);
    ASSERT_TRUE(less.light) << less.messages;
    EXPECT_LT(less.light->samples, discs.light->samples);
    EXPECT_LE(less.light->work_seconds, work_seconds);
    EXPECT_EQ(lit(plant_text(black, pair), {}, 3, work_seconds).light->samples, less.light->samples);
}

// A disc is a leaf, whether a turtle draws it or a model that it places.
TEST(PlantLight, OnModelsThatAreDiscs) {
    const auto block = [](const std::string& body, const std::string& placed) {
        return black + "lsys blade {\n steps 0\n colors leaf\n axiom " + body +
               "\n}\nmain lsys s {\n steps 0\n axiom &(90)" + placed + "\n}\n";
    };
    const LitPlant disc = lit(block("@o(2)", "~blade"), 64);
    ASSERT_TRUE(disc.light) << disc.messages;
    ASSERT_EQ(disc.light->lit_organs, 1u);
    EXPECT_NEAR(disc.plant->modules[0].area, pi, 1e-9);
    EXPECT_NEAR(disc.light->falls.amount, pi, 1e-6);
    EXPECT_NEAR(disc.at(0), 1, 1e-6);
    const LitPlant stretched = lit(block("@o(2)", "~blade(3,0.5,2)"), 64);
    ASSERT_TRUE(stretched.light) << stretched.messages;
    EXPECT_NEAR(stretched.plant->modules[0].area, 1.5 * pi, 1e-9);
    EXPECT_NEAR(stretched.light->falls.amount, 1.5 * pi, 1e-6);
    const LitPlant flower = lit(block("[@o(2)][f(3)@o(4)][+f(3)" + square(1) + "]", "~blade(0.5)"), 64);
    ASSERT_TRUE(flower.light) << flower.messages;
    EXPECT_NEAR(flower.plant->modules[0].area, (5 * pi + 1) / 4, 1e-9);
    // A disc over another takes its light.
    const LitPlant pair = lit(block("@o(2)", "[~blade][^(90)f(0.01)&(90)~blade]"), 1024);
    ASSERT_TRUE(pair.light) << pair.messages;
    EXPECT_NEAR(pair.light->falls.amount, pi, 0.05);
    EXPECT_FALSE(lit(block("@O(2)", "~blade"), 64).plant->modules[0].is_measured) << "a ball is no leaf";
}

// Parts that chance makes are shared: where chance alone says where they stand, they lie in each other.
TEST(PlantLight, WarnsOfOrgansThatLieInOthers) {
    const std::string grove = "lsys a {\n steps 9\n axiom A\n A -> AA\n interpret A -> [@M(random(0,80),0,"
                              "random(0,80))&(90)@o(1)]\n}\n";
    const LitPlant shared = lit(grove, 4), exact = lit(grove, 4, 1, 1000, true);
    ASSERT_TRUE(shared.light && exact.light);
    EXPECT_NE(shared.messages.find("448 of 512 organs lie exactly in others"), std::string::npos)
        << shared.messages;
    EXPECT_NE(shared.messages.find("--exact"), std::string::npos);
    EXPECT_EQ(exact.messages.find("lie exactly"), std::string::npos) << exact.messages;
    const std::string tree = "lsys a {\n width 0.1\n steps 6\n axiom A\n"
                             " A -> F(1)[+(random(20,40))A][-(random(20,40))A]\n}\n";
    const LitPlant apart = lit(tree, 4);
    ASSERT_TRUE(apart.light) << apart.messages;
    EXPECT_EQ(apart.messages.find("lie exactly"), std::string::npos) << apart.messages;
    const std::string twice = "axiom [&(90)" + square(1) + "][&(90)" + square(1) + "]";
    EXPECT_EQ(lit(plant_text(black, twice), 4).messages.find("lie exactly"), std::string::npos)
        << "the author says so";
}

TEST(PlantLight, KeepsToItsWork) {
    const std::string text = plant_text(green, layer(300, 0.3, false));
    const LitPlant whole = lit(text, 64);
    ASSERT_TRUE(whole.light) << whole.messages;
    const LitPlant part = lit(text, 64, 1, 0.3 * whole.light->work_seconds);
    ASSERT_TRUE(part.light) << part.messages;
    EXPECT_LT(part.light->samples, 64);
    EXPECT_NE(part.messages.find("samples of its light, not 64"), std::string::npos) << part.messages;
    const LitPlant usual = lit(text, {}, 1, 0.3 * whole.light->work_seconds);
    ASSERT_TRUE(usual.light) << usual.messages;
    EXPECT_EQ(usual.light->samples, part.light->samples);
    EXPECT_EQ(usual.messages, part.messages);
    const LitPlant none = lit(text, 64, 1, 0.01 * whole.light->work_seconds);
    EXPECT_FALSE(none.light);
    EXPECT_NE(none.messages.find("seconds of work"), std::string::npos) << none.messages;
}

// A module that is drawn as others has the mean of their light.
TEST(PlantLight, OfWholes) {
    const LitPlant whole = lit(plant_text(green, "axiom L\n interpret L -> [f(1)&(90)" + square(1) +
                                                     "][f(3)&(90)" + square(2) + "]"),
                               256);
    ASSERT_TRUE(whole.light) << whole.messages;
    ASSERT_EQ(whole.plant->modules.size(), 3u);
    EXPECT_NEAR(whole.at(0), (whole.at(1) + 4 * whole.at(2)) / 5, 1e-6);
}

} // namespace
} // namespace graftal
