#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Imported houdini(const std::string& lines, LowerOptions options = {}) {
    return Imported("plant.txt", lines, options);
}

/// The ends of the segments of a premise.
std::vector<Vec3> houdini_ends(const std::string& premise, const std::string& settings = "") {
    const Imported model = houdini(settings + "Premise: " + premise + "\nRule 1: Z=Z\n");
    return model.ends();
}

TEST(Houdini, TheTreeOfANewNodeHasTheCountsOfTheSameSystemByHand) {
    const Imported model = houdini("A tree\nPremise: FFFA\nRule 1: A=!\"[B]////[B]////B\nRule 2: B=&FFFAJ\n");
    const Imported by_hand("hand.lsys", "lsys tree {\n modules J\n steps 7\n angle 28\n axiom FFFA\n"
                                        " A -> [B]////[B]////B\n B -> &FFFAJ\n}\n");
    EXPECT_EQ(model.segment_count(), by_hand.segment_count());
    EXPECT_THAT(model.translation, HasSubstr("# A tree\n"));
    EXPECT_THAT(model.translation, HasSubstr("  step 0.1\n"));
    EXPECT_THAT(model.translation, HasSubstr("  B -> &FFFA"));
    EXPECT_THAT(model.said(), HasSubstr("'J': the geometry of an input is not in the text"));
}

TEST(Houdini, TurnsAreThoseOfItsTurtle) {
    expect_near(houdini_ends("+(90)F(2)").back(), {2, 0, 0}); // to the right
    expect_near(houdini_ends("-(90)F(2)").back(), {-2, 0, 0});
    expect_near(houdini_ends("^(90)F(1)").back(), {0, 0, 1}); // up, to the eye
    expect_near(houdini_ends("&(90)F(1)").back(), {0, 0, -1});
    expect_near(houdini_ends("\\(90)^(90)F(1)").back(), {1, 0, 0}); // clockwise
    expect_near(houdini_ends("/(90)^(90)F(1)").back(), {-1, 0, 0});
    expect_near(houdini_ends("|F(1)").back(), {0, -1, 0});
    expect_near(houdini_ends("*^(90)F(1)").back(), {0, 0, -1});
    const double angle = 28 * std::acos(-1.0) / 180;
    expect_near(houdini_ends("+F(1)").back(), {std::sin(angle), std::cos(angle), 0});
    expect_near(houdini_ends("+F(1)", "Angle: 90\n").back(), {1, 0, 0});
}

TEST(Houdini, LengthsThatAreNotWrittenAreScaled) {
    expect_near(houdini_ends("F").back(), {0, 0.1, 0});
    expect_near(houdini_ends("\"F").back(), {0, 0.09, 0});
    expect_near(houdini_ends("\"(0.5)\"(0.5)F", "Step Size: 4\n").back(), {0, 1, 0});
    expect_near(houdini_ends("\"(0.5)F(3)F", "Step Size = 4\n").back(), {0, 5, 0});
    expect_near(houdini_ends("_F", "Step Size: 1\nStep Size Scale: 0.5\n").back(), {0, 2, 0});
    expect_near(houdini_ends("HhF", "Step Size: 1\n").back(), {0, 2, 0});
    expect_near(houdini_ends("H(3)").back(), {0, 1.5, 0});
    expect_near(houdini_ends(";+F(1)", "Angle: 60\nAngle Scale: 1.5\n").back(), {1, 0, 0});
    expect_near(houdini_ends("@+F(1)", "Angle: 60\nAngle Scale: 2\n").back(), {0.5, std::sqrt(0.75), 0});
}

TEST(Houdini, AWidthBelongsToItsSegment) {
    const Imported model = houdini("Thickness: 0.1\nPremise: F(1)F(1, 0.3)F(1)!(0.5)F(1)\nRule 1: Z=Z\n");
    ASSERT_TRUE(model.graph) << model.said();
    std::vector<double> radii = model.radii();
    ASSERT_EQ(radii.size(), 4u);
    std::ranges::sort(radii);
    EXPECT_NEAR(radii[0], 0.025, 1e-9);
    EXPECT_NEAR(radii[1], 0.05, 1e-9);
    EXPECT_NEAR(radii[2], 0.05, 1e-9);
    EXPECT_NEAR(radii[3], 0.15, 1e-9);
    expect_near(houdini_ends("F(1)F(2, 0.3)F(3)").back(), {0, 6, 0});
}

TEST(Houdini, GravityBendsOnceTowardsTheGround) {
    expect_near(houdini_ends("^(90)T(30)F(1)").back(), {0, -0.5, std::sqrt(0.75)});
    expect_near(houdini_ends("^(90)T(30)F(1)F(1)").back(), {0, -1, 2 * std::sqrt(0.75)});
    expect_near(houdini_ends("T(30)F(1)").back(), {0, 1, 0}); // straight up there is no direction to bend
    expect_near(houdini_ends("^(90)TF(1)", "Gravity: 30\n").back(), {0, -0.5, std::sqrt(0.75)});
}

TEST(Houdini, ConditionsAskParametersAndTheGeneration) {
    const std::string begin = "Generations: 9\nPremise: A(0)\n";
    EXPECT_EQ(houdini(begin + "Rule 1: A(i):i<3=F(1)A(i+1)\n").segment_count(), "3");
    EXPECT_EQ(houdini(begin + "Rule 1: A(i) : i<5 & i!=2 = F(1)A(i+1)\n").segment_count(), "2");
    EXPECT_EQ(houdini(begin + "Rule 1: A(i):(i==0)|(i>=1)=FA(1)\n").segment_count(), "9");
    EXPECT_EQ(houdini("Generations: 9\nPremise: A\nRule 1: A:t<3=FA\n").segment_count(), "3"); // 0, 1, 2
    EXPECT_EQ(houdini(begin + "b = 4\nRule 1: A(i):i<b=F(1)A(i+1)\n").segment_count(), "4");
    EXPECT_EQ(houdini("Generations: 2\nPremise: A(3)A(4)\nRule 1: A(3)=F\n").segment_count(), "1");
}

TEST(Houdini, ParametersThatAreMissingAreZero) {
    const Imported fewer = houdini("Generations: 1\nPremise: A(2)\nRule 1: A(i,j)=F(i)F(j+1)\n");
    ASSERT_TRUE(fewer.graph) << fewer.said();
    expect_near(fewer.segments().back().second, {0, 3, 0});
    EXPECT_EQ(houdini("Generations: 1\nPremise: A(5)AA(1,2)\nRule 1: A=F(1)\n").segment_count(), "3");
}

TEST(Houdini, ContextsAreThoseBesideASymbol) {
    const std::string begin = "Generations: 1\nPremise: ABC+BAB\n";
    EXPECT_EQ(houdini(begin + "Rule 1: A<B=F\n").segment_count(), "2");
    EXPECT_EQ(houdini(begin + "Rule 1: A < B > C = F\n").segment_count(), "1");
    EXPECT_EQ(houdini(begin + "Rule 1: C<B=F\n").segment_count(), "0");
    EXPECT_EQ(houdini(begin + "Context Ignore: +-\nRule 1: C<B=F\n").segment_count(), "1");
    EXPECT_EQ(houdini("Generations: 1\nPremise: A(3)B(1)\nRule 1: A(i)<B(j)=F(i+j)F\n").segment_count(), "2");
}

TEST(Houdini, WhatProbabilitiesLeaveStaysAsItIs) {
    const std::string begin = "Generations: 1\nPremise: " + std::string(2000, 'A') + "\nRule 1: A=F:0.3\n";
    const Imported alone = houdini(begin);
    EXPECT_THAT(alone.translation, HasSubstr("  A -> F : 0.3\n"));
    EXPECT_NEAR(std::stod(alone.segment_count()), 600, 120) << alone.said();
    const Imported rest = houdini(begin + "Rule 2: A=FF\n");
    EXPECT_THAT(rest.translation, HasSubstr("  A -> FF : max(0, 1 - (0.3))\n"));
    EXPECT_NEAR(std::stod(rest.segment_count()), 600 + 2 * 1400, 120) << rest.said();
    const Imported both = houdini(begin + "Rule 2: A=FF:0.2\n");
    EXPECT_NEAR(std::stod(both.segment_count()), 600 + 2 * 400, 160) << both.said();
}

TEST(Houdini, RandomTurnsAreWithinTheirAngle) {
    const std::vector<Vec3> all = houdini_ends("[~(20)F(1)][~(20)F(1)]");
    ASSERT_EQ(all.size(), 2u);
    EXPECT_GT(glm::length(all[0] - all[1]), 1e-3);
    for (const Vec3 end : all)
        EXPECT_GT(end.y, std::cos(40 * std::acos(-1.0) / 180));
}

TEST(Houdini, SymbolsOfTheTurtleMayHaveRules) {
    EXPECT_EQ(houdini("Generations: 3\nPremise: F\nRule 1: F=F+F\n").segment_count(), "8");
    EXPECT_EQ(houdini("Generations: 3\nPremise: H\nRule 1: H=HH\n").segment_count(), "8");
    EXPECT_EQ(houdini("Generations: 2\nPremise: +\nRule 1: +=+F\n").segment_count(), "2");
    EXPECT_EQ(houdini("Generations: 2\nPremise: \"\nRule 1: \"=\"F\n").segment_count(), "2");
    EXPECT_EQ(houdini("Generations: 2\nPremise: J\nRule 1: J=FJ\n").segment_count(), "2");
    EXPECT_EQ(houdini("Generations: 2\nPremise: gT\nRule 1: g=Fg\n").segment_count(), "2");
}

TEST(Houdini, LinesAreWrittenInManyWays) {
    for (const char* const text :
         {"Premise: F\nRule 1: F=FF\nGenerations: 3\n",
          "- **Premise:** `F`\n- Rule 1 : `F = FF`\n generations = 3\n",
          "Premise = F\nRule1 = F=FF\nGenerations = 3 or so\n",
          "premise: F \\\nRule #1: F=FF \\\nGenerations: 3\n",
          "Premise:\n\nF\nRules:\nF=FF\n\nIterations: 3\n", "premise\tF\nrule\tF=FF\ngenerations\t3\n",
          "Generations: 3\nPremise: F\nF = FF\n", "Premise: F\nRules: (by hand)\n1. F=FF\nGenerations: 3\n",
          "1. Premise: F\n2. Rule: F->FF\nGenerations: 3\n"})
        EXPECT_EQ(houdini(text).segment_count(), "8") << text;
}

TEST(Houdini, EachPremiseBeginsAModel) {
    const std::string text =
        "One\nPremise: F\nRule 1: F=FF\nGenerations: 1\nTwo\nPremise:\nFFF\nRule 1: F=FF\n"
        "Generations: 1\n";
    EXPECT_EQ(Imported("plant.txt:plant_1", text).segment_count(), "2");
    EXPECT_EQ(Imported("plant.txt:plant_2", text).segment_count(), "6");
    EXPECT_THAT(Imported("plant.txt", text).said(), HasSubstr("'plant.txt' holds 2 models"));
}

TEST(Houdini, SaysWhatIsWrong) {
    const auto said = [](const std::string& rule) {
        return houdini("Premise: A(1)\nRule 1: " + rule).said();
    };
    EXPECT_THAT(said("A=F(x)\n"), HasSubstr("plant.txt:2:9: error: 'x' is no parameter here"));
    EXPECT_THAT(said("A(x):in(x,0,0)=F\n"), HasSubstr("the function 'in' has no translation"));
    EXPECT_THAT(said("AB=F\n"), HasSubstr("a rule rewrites one symbol"));
    EXPECT_THAT(said("A=F(1\n"), HasSubstr("parentheses close the parameters of one symbol"));
    EXPECT_THAT(said("A F\nB=F\n"), HasSubstr("a rule is written symbol=replacement"));
    EXPECT_THAT(said("A=`strdup(3)`F(`$F`)\n"), HasSubstr("in backquotes has no translation"));
    EXPECT_THAT(houdini("Premise: A\nRule 1: A=F\nAngle: wide\n").said(),
                HasSubstr("plant.txt:3:8: error: expected a number, found 'wide'"));
    EXPECT_THAT(houdini("Premise: A\nRule 1: A=F(b)\n").said(), HasSubstr("the text gives no value for 'b'"));
    EXPECT_THAT(said("A=F'(0.1)#\n"), HasSubstr("warning: '''"));
    EXPECT_THAT(houdini("Premise: A\nnothing else\n").said(), HasSubstr("is no"));
    EXPECT_THAT(said("A=F\n"), Not(HasSubstr("error")));
}

} // namespace
} // namespace graftal::testing
