// Queries and environments in derivation, and what the turtle knows of the world.

#include <algorithm>
#include <array>
#include <string>

#include <gmock/gmock.h>

#include "compiler/lsys/turtle/model_placer.h"
#include "tests/unit/lsys/turtle.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

std::vector<Stroke> drawn(const std::string& statements, unsigned steps, bool exact = false) {
    LowerOptions options;
    options.exact = exact;
    return Unfolding(CompiledLsys(statements, steps, options).graph).strokes;
}

std::string said(const std::string& statements) {
    SourceMap sources;
    Diagnostics diagnostics;
    lower_text("m.lsys", "lsys m {\nsteps 2\n" + statements + "\n}\n", {}, sources, diagnostics);
    return diagnostics.render(sources);
}

TEST(Queries, HearWhereTheTurtleIsBeforeTheNextStep) {
    // Each step adds a segment until the place is high enough.
    const std::vector<Stroke> strokes = drawn("axiom A?P(0, 0)\nA > ?P(x, y) : y < 2.5 -> FA\n", 9);
    EXPECT_EQ(strokes.size(), 3U);
}

TEST(Queries, HearDirectionsAndAsMuchAsTheyAskFor) {
    const std::vector<Stroke> strokes =
        drawn("axiom +(90)&(90)A?H(0, 0, 0)?U(0, 0, 0)?L(0, 0)\n"
              "A > ?H(a, b, c)?U(d, e, f)?L(g, h) -> "
              "[@R(1, 0, 0)F(10+a)F(20+b)F(30+c)F(40+d)F(50+e)F(60+f)F(70+g)F(80+h)]",
              1);
    ASSERT_EQ(strokes.size(), 8U);
    // Heading -z, z axis -x, left -y.
    const std::array<double, 8> lengths = {10, 20, 29, 39, 50, 60, 70, 79};
    for (std::size_t i = 0; i < lengths.size(); ++i)
        EXPECT_NEAR(strokes[i].to.x - strokes[i].from.x, lengths[i], 1e-9) << i;
}

TEST(Queries, AreAskedAsInterpretationDraws) {
    const std::vector<Stroke> strokes =
        drawn("axiom BA?P(0, 0)\nA > ?P(x, y) : y > 4 -> F\ninterpret B -> F(5)\n", 2);
    ASSERT_EQ(strokes.size(), 2U);
    EXPECT_NEAR(strokes[1].from.y, 5, 1e-9);
}

TEST(Queries, OfTheEnvironmentPrune) {
    const std::string tree = "angle 30\nenvironment sphere 0, 2, 0, 3\naxiom F?E(0)A\n"
                             "?E(d) < A : d < 0 -> F[+?E(0)A][-?E(0)A]\n";
    const std::vector<Stroke> strokes = drawn(tree, 12);
    EXPECT_GT(strokes.size(), 20U);
    for (const Stroke& stroke : strokes)
        EXPECT_LT(glm::length(stroke.from - Vec3(0, 2, 0)), 3 + 1e-9);
    EXPECT_EQ(drawn(tree, 40).size(), strokes.size()) << "it ends by itself";
}

TEST(Queries, NeverMeetInACrowd) {
    const std::vector<Stroke> strokes = drawn("angle 90\nenvironment crowd 0.01\naxiom [FA][+FA][-FA][|FA]\n"
                                              "f ?E(free) : free == 1 -> FA\n"
                                              "f ?E(free) : free == 0 -> *\n"
                                              "decompose A -> ?E(2)[+f?E(1)][-f?E(1)]f?E(1)\n",
                                              8);
    EXPECT_GT(strokes.size(), 20U);
    for (std::size_t i = 0; i < strokes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GT(glm::length(strokes[i].to - strokes[j].to), 0.5);
}

TEST(Queries, GiveTheSameModelEachTime) {
    const std::string colony =
        "angle 40\nseed 4\nenvironment sphere 0, 6, 0, 4\nenvironment points 300, 5, 0.7\n"
        "axiom FFA?E(0, 0, 0, 0)\n"
        "A > ?E(n, x, y, z) : n > 0 -> [@R(x, y, z)FA?E(0, 0, 0, 0)][/(random(0, 360))&fA?E(0, 0, 0, 0)]\n";
    const std::vector<Stroke> first = drawn(colony, 6), second = drawn(colony, 6);
    ASSERT_EQ(first.size(), second.size());
    EXPECT_GT(first.size(), 8U);
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_EQ(first[i].to, second[i].to);
}

TEST(Queries, SaysWhatIsWrong) {
    EXPECT_THAT(said("axiom F?E(1)"), HasSubstr("'?E' hears nothing"));
    EXPECT_THAT(said("environment sfere 0, 0, 0, 1\naxiom F?E(1)"),
                HasSubstr("there is no environment 'sfere'"));
    EXPECT_THAT(said("environment sphere 0, 0, 0\naxiom F?E(1)"),
                HasSubstr("'sphere' takes 4 numbers, not 3"));
    EXPECT_THAT(said("environment sphere 0, 0, 0, -1\naxiom F?E(1)"),
                HasSubstr("the radius must be positive"));
    EXPECT_THAT(said("environment crowd 1\nenvironment rivals\naxiom F?E(1)"),
                HasSubstr("'crowd' and 'rivals' cannot both answer"));
    EXPECT_THAT(said("environment points 9, 1, 1\naxiom F?E(1)"), HasSubstr("'points' needs a region"));
    EXPECT_THAT(said("environment plane 0, 1, 0, 0\nenvironment points 9, 1, 1\naxiom F?E(1)"),
                HasSubstr("need regions that end"));
    EXPECT_THAT(said("environment shade 2\naxiom F?E(1)"), HasSubstr("a transmittance lies from 0 to 1"));
    EXPECT_THAT(said("environment shade 0.5, 0, 1, 0\naxiom F?E(1)"), HasSubstr("a source is x, y, z"));
    EXPECT_THAT(said("environment shadows 1, 1, 2, 99\naxiom F?E(1)"),
                HasSubstr("the depth is a whole number"));
    EXPECT_THAT(said("bending sideways\naxiom F"), HasSubstr("expected 'after' or 'before'"));
    EXPECT_THAT(said("axiom F@T(2, 1)F"), HasSubstr("there is no tropism 2"));
    EXPECT_THAT(said("axiom F@R(0, 0, 0)F"), HasSubstr("'@R' needs a direction"));
    EXPECT_THAT(said("steps infinite\naxiom A?P(0)\nA -> FA"), HasSubstr("duplicate 'steps'"));
}

TEST(TheWorld, PlacesAndDirectionsAreTheSameInEveryPart) {
    for (const char* productions :
         {"A -> F[+A][-A]&(20)[@M(3, 4, 5)F(0.2)]/(50)", "A -> F[+A]/(40)[&A][@R(1, 2, 0.5)F(0.3)+F(0.3)]",
          "A -> F[@Di(0.7)+A][@F-A][@M(1, 0, 2)@R(0, 0, 1, 0, 1, 0)F(0.4)&F(0.4)]"}) {
        const std::string statements = std::string("angle 25\nwidth 0.1\naxiom A\n") + productions;
        auto key = [](const Stroke& s) {
            const auto round = [](double x) { return std::round(x * 1e6); };
            return std::array{round(s.from.x), round(s.from.y), round(s.from.z),
                              round(s.to.x),   round(s.to.y),   round(s.to.z)};
        };
        std::vector<Stroke> composed = drawn(statements, 5), derived = drawn(statements, 5, true);
        std::ranges::sort(composed, {}, key);
        std::ranges::sort(derived, {}, key);
        ASSERT_EQ(composed.size(), derived.size()) << statements;
        ASSERT_GT(composed.size(), 20U);
        for (std::size_t i = 0; i < composed.size(); ++i)
            EXPECT_LT(glm::length(composed[i].to - derived[i].to), 1e-5) << statements;
    }
    const std::vector<Stroke> strokes = drawn("axiom +(70)F&(33)F@M(3, 4, 5)@R(0, 0, 2)F(0.5)", 0);
    ASSERT_EQ(strokes.size(), 3U);
    EXPECT_NEAR(glm::length(strokes[2].from - Vec3(3, 4, 5)), 0, 1e-9);
    EXPECT_NEAR(glm::length(strokes[2].to - Vec3(3, 4, 5.5)), 0, 1e-9);
}

TEST(TheWorld, SeveralTropismsBendTowardsTheirSum) {
    const std::string both = "width 0.1\ntropism 0, -1, 0\ntropism 1, 0, 0\n";
    const std::vector<Stroke> one = drawn("width 0.1\ntropism 3, -4, 0\naxiom +(50)T(0.5)FFF", 0);
    const std::vector<Stroke> two = drawn(both + "axiom +(50)T(0.4)@T(2, 0.3)FFF", 0);
    ASSERT_EQ(one.size(), 3U);
    ASSERT_EQ(two.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LT(glm::length(one[i].to - two[i].to), 1e-9);
    const std::string tree = both + "angle 35\naxiom T(0.1)A\nA -> F[+@T(2, 0.2)A]@K(0.05)[-A]/(90)";
    const std::vector<Stroke> composed = drawn(tree, 5), derived = drawn(tree, 5, true);
    ASSERT_EQ(composed.size(), derived.size());
    double sum_composed = 0, sum_derived = 0;
    for (std::size_t i = 0; i < composed.size(); ++i) {
        sum_composed += composed[i].to.x + 2 * composed[i].to.y + 3 * composed[i].to.z;
        sum_derived += derived[i].to.x + 2 * derived[i].to.y + 3 * derived[i].to.z;
    }
    EXPECT_NEAR(sum_composed, sum_derived, 1e-4);
}

TEST(TheWorld, TropismsAtAnAngleLeadToIt) {
    std::string far = "width 0.1\ntropism 0, 1, 0, 90\naxiom +(20)T(0.1)";
    for (int i = 0; i < 60; ++i)
        far += "F";
    const std::vector<Stroke> strokes = drawn(far, 0);
    const Vec3 last = strokes.back().to - strokes.back().from;
    EXPECT_NEAR(last.y, 0, 0.01);
    EXPECT_LT(last.x, -0.99);
}

TEST(TheWorld, TorquesRollUntilZIsNear) {
    std::string far = "width 0.1\ntorque 1, 0, 0\naxiom T(0.2)";
    for (int i = 0; i < 60; ++i)
        far += "F";
    // Then a pitch up leads towards z.
    const std::vector<Stroke> strokes = drawn(far + "^(90)T(0)F", 0);
    EXPECT_NEAR(strokes.back().to.x - strokes.back().from.x, 1, 1e-3);
    EXPECT_NEAR(strokes.back().from.x, 0, 1e-9) << "it bends nothing";
}

TEST(TheWorld, BendingSaysWhen) {
    const auto end = [](const std::string& bending) {
        return drawn("width 0.1\ntropism 1, 0, 0\n" + bending + "\naxiom T(0.5)fFF", 0).back().to;
    };
    EXPECT_EQ(end("bending after segments"), end(""));
    const Vec3 segments = end(""), moves = end("bending after moves"), before = end("bending before moves");
    EXPECT_GT(moves.x, segments.x + 0.1);
    EXPECT_GT(before.x, moves.x + 0.1);
}

TEST(TheWorld, WidthsAdd) {
    const std::vector<Stroke> strokes = drawn("width 0.3\naxiom F[@I(-0.1)F@I(-0.5)F]@I(0.2)F", 0);
    ASSERT_EQ(strokes.size(), 3U) << "one has no width";
    std::vector<double> widths;
    for (const Stroke& stroke : strokes)
        widths.push_back(stroke.width);
    std::ranges::sort(widths);
    EXPECT_NEAR(widths[0], 0.2, 1e-9);
    EXPECT_NEAR(widths[1], 0.3, 1e-9);
    EXPECT_NEAR(widths[2], 0.5, 1e-9);
}

TEST(TheWorld, ModelsHaveASizeForEachAxis) {
    EXPECT_EQ(placed_scale(std::array{2.0, 3.0, 5.0}), Vec3(2, 3, 5));
    EXPECT_EQ(placed_scale(std::array{2.0, 8.0}), Vec3(2, 8, 4));
    EXPECT_EQ(placed_scale(std::array{2.0}), Vec3(2, 2, 2));
}

} // namespace
} // namespace graftal::testing
