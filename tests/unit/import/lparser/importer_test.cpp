#include <cmath>

#include <gmock/gmock.h>

#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The ends of the segments of an axiom, per length of F.
std::vector<Vec3> ends(const std::string& axiom) {
    const Imported model("a.ls", "0\n90\n10\n" + axiom + "\n@\n");
    std::vector<Vec3> all = model.ends();
    for (Vec3& end : all)
        end /= 100.0;
    return all;
}

TEST(Lparser, ReadsBothLayouts) {
    const Imported by_lines("a.ls", "# a tree\n3 # depth\n45\n20\nA # the axiom\nA=F[+A][-A]\n@\nthe end\n");
    const Imported by_words("a.ls", "recursion 3\nangle 45\nthickness 20\naxiom A\nrule A = F[+A] [-A]\n");
    EXPECT_EQ(by_lines.derivation->segments, "7") << by_lines.said();
    EXPECT_EQ(by_words.derivation->segments, "7") << by_words.said();
    EXPECT_THAT(by_lines.translation, HasSubstr("# a tree\n"));
    EXPECT_THAT(by_lines.translation, HasSubstr("  steps 3   # depth\n"));
    EXPECT_THAT(by_lines.translation, HasSubstr("  A -> F[+A][-A]\n"));
}

TEST(Lparser, LengthsAreMultipliedAndOthersWritten) {
    expect_near(ends("'(.5)F").back(), {0, 0.5, 0});
    expect_near(ends("'F").back(), {0, 0.9, 0});
    expect_near(ends("\"ZF").back(), {0, 1.5 / 0.9, 0});
    expect_near(ends("'(.5)F(100)F").back(), {0, 1.5, 0}); // what is written does not shrink
}

TEST(Lparser, RefusesScalesThatVanish) {
    // Each A takes up two of the A before it, without brackets: their scales are multiplied.
    for (const char* const axiom : {"A={.+(3)F'A.+F.F}A", "A=F'AA", "A=F\"AA", "A=F'(.5)A[A]A"}) {
        const Imported model("a.ls", std::string("30\n20\n10\nA\n") + axiom + "\n@\n");
        EXPECT_FALSE(model.graph);
        EXPECT_THAT(model.said(), HasSubstr("the scale of the turtle leaves the range of numbers"));
    }
}

TEST(Lparser, WritesOnlyProductionsThatApply) {
    for (const char* const axiom :
         {"{F}Z", "{F(5)}z(3)", "t(.1)F", "tF", "~F", "~(5)F", "Zz(1)", "a(7)F\na=Fb\nb=F", "f(3)F\nf=g"}) {
        const Imported model("a.ls", std::string("3\n90\n10\n") + axiom + "\n@\n");
        EXPECT_TRUE(model.graph);
        EXPECT_EQ(model.said(), "") << axiom;
    }
}

TEST(Lparser, AnglesAreMultipliedAndOthersWritten) {
    expect_near(ends(":(.5)+F").back(), {-std::sqrt(0.5), std::sqrt(0.5), 0});
    expect_near(ends(":(.5)+(90)F").back(), {-1, 0, 0});
}

TEST(Lparser, SegmentsAreAsThickAsTheirLengthSays) {
    const Imported model("a.ls", "0\n90\n50\nF'(.5)F!F\n@\n");
    ASSERT_TRUE(model.graph) << model.said();
    const std::vector<double> radii = model.radii();
    ASSERT_EQ(radii.size(), 3u);
    EXPECT_NEAR(radii[0], 25, 1e-9);
    EXPECT_NEAR(radii[1], 12.5, 1e-9);
    EXPECT_NEAR(radii[2], 12.5 * 0.7, 1e-9);
}

TEST(Lparser, TurnsAreReversedOnceTheTurtleIsLevel) {
    expect_near(ends("&(90)+F").back(), {-1, 0, 0});
    expect_near(ends("&(90)$+F").back(), {1, 0, 0}); // a quirk of the program
    expect_near(ends("&(90)[$+F]+F").back(), {-1, 0, 0});
}

TEST(Lparser, BranchesBendTheMoreTheMoreLevelTheyAre) {
    expect_near(ends("t(1)F").back(), {0, 1, 0});
    const double angle = std::acos(-1.0) / 6 + 0.5 * std::sin(std::acos(-1.0) / 6);
    expect_near(ends("&(30)t(.5)F").back(), {0, std::cos(angle), -std::sin(angle)});
}

TEST(Lparser, RandomTurnsAreWithinTheirAngle) {
    const Imported model("a.ls", "0\n90\n10\n[~(20)F][~(20)F]\n@\n");
    const auto segments = model.segments();
    ASSERT_EQ(segments.size(), 2u) << model.said();
    EXPECT_GT(glm::length(segments[0].second - segments[1].second), 1e-3);
    for (const auto& [from, to] : segments)
        EXPECT_GT(to.y, 100 * std::cos(40 * std::acos(-1.0) / 180));
}

TEST(Lparser, WhatIsWrittenBehindASymbolStaysBehindWhatItBecomes) {
    const Imported model("a.ls", "1\n90\n10\nA(50)\nA=BF\n@\n");
    const auto segments = model.segments();
    ASSERT_EQ(segments.size(), 1u) << model.said();
    EXPECT_NEAR(segments[0].second.y, 50, 1e-9);
}

TEST(Lparser, NumbersThatAreNoneAreNone) {
    const Imported model("a.ls", "1\n90\n10\nA(50)F(x)F\nA=F(x)\n@\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("a.ls:4:6: warning: 'x' is read as the number 0"));
    EXPECT_THAT(model.translation, HasSubstr("  A(x) -> F(0)\n"));
}

TEST(Lparser, SignsWithoutAMeaningAreSaid) {
    const Imported model("a.ls", "1\n90\n10\nA\nA=F/F*B\n*=F\n@\n");
    EXPECT_THAT(model.said(), HasSubstr("a.ls:5:4: warning: '/' means nothing to the L-Parser"));
    EXPECT_THAT(model.said(), Not(HasSubstr("'*'"))) << "it has a rule";
    EXPECT_THAT(model.said(), Not(HasSubstr("'B'"))) << "a letter may be a state";
}

TEST(Lparser, SymbolsWithNamesAreToldFromLetters) {
    const Imported model("a.ls", "1\n90\n10\nA\nA=At@S\n@\n");
    EXPECT_THAT(model.translation, HasSubstr("  A -> A t At S\n")) << model.said();
}

TEST(Lparser, ANumberWithoutMeaningKeepsNoRuleFromItsSymbol) {
    const Imported model("a.ls", "1\n90\n10\n|(3)\n|=F\n@\n");
    EXPECT_EQ(model.segments().size(), 1u) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("the number of '|' means nothing"));
}

TEST(Lparser, BlocksAreDrawnWithinPolygons) {
    const Imported model("a.ls", "1\n90\n10\n{.F.+f.A}\nA=F\n@\n");
    EXPECT_EQ(model.segments().size(), 2u) << model.said();
}

TEST(Lparser, ScaledSpiralsFold) {
    const Imported shell("a.ls",
                         "recursion 500\nangle 20\nthickness 50\naxiom A\nrule A = F+>'(0.99)[&A]A\n");
    ASSERT_TRUE(shell.graph) << shell.said();
    EXPECT_LT(shell.derivation->parts, 2000u);
}

TEST(Lparser, SaysWhatIsWrong) {
    const auto said = [](const std::string& text) { return Imported("a.ls", text).said(); };
    EXPECT_THAT(said("3\nninety\n10\nA\n@\n"),
                HasSubstr("a.ls:2:1: error: expected a number, found 'ninety'"));
    EXPECT_THAT(said("3\n90\n10\n"), HasSubstr("the file has no axiom"));
    EXPECT_THAT(said("3\n90\n10\nF(2)\n2=3\n@\n"), HasSubstr("would rewrite the '2' of numbers"));
    EXPECT_THAT(said("3.5\n90\n10\nF\n@\n"), HasSubstr("no whole number"));
    EXPECT_THAT(said("3\n90\n10\nF\nA=(5)\n@\n"),
                HasSubstr("a.ls:5:3: error: a string that begins with a number"));
    EXPECT_THAT(said("recursion 3\nspin 4\naxiom F\n"), HasSubstr("'spin' is no keyword of L-Parser"));
}

} // namespace
} // namespace graftal::testing
