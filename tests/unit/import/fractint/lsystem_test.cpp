#include <cmath>

#include <gmock/gmock.h>

#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

Imported fractint(const std::string& lines, unsigned steps) {
    return Imported("a.l", "Model {\n" + lines + "}\n", {.steps = steps});
}

TEST(FractintLsystem, KeepsNamesCommentsAndStructure) {
    const Imported model("a.l", "Dragon {   ; by H. Heighway\n  Angle 8  ; 45 degrees\n  Axiom FX\n  F=\n"
                                "  y=+FX--FY+\n  x=-FX++FY-\n}\n");
    EXPECT_EQ(model.translation, "# Dragon: an L-system of Fractint\n"
                                 "# by H. Heighway\n"
                                 "lsys Dragon {\n"
                                 "  angle 360/8   # 45 degrees\n"
                                 "  steps 12   # Fractint's order; with this it draws 4096 lines\n"
                                 "  axiom -(90)FX\n"
                                 "  F -> *\n"
                                 "  Y -> +FX--FY+\n"
                                 "  X -> -FX++FY-\n"
                                 "}\n");
}

TEST(FractintLsystem, DrawsToTheRightAndTurnsLeft) {
    const auto segments = fractint("Angle 4\nAxiom F+F\n", 0).segments();
    ASSERT_EQ(segments.size(), 2u);
    EXPECT_NEAR(segments[0].second.x, 1, 1e-9);
    EXPECT_NEAR(segments[1].second.x, 1, 1e-9);
    EXPECT_NEAR(segments[1].second.y, 1, 1e-9);
}

TEST(FractintLsystem, RulesGivenTwiceAreAppended) {
    EXPECT_EQ(fractint("Angle 4\nAxiom F\nF=F+F\nF=-F-F\n", 3).derivation->segments, "64");
}

TEST(FractintLsystem, TheSizeIsMultipliedAndRestored) {
    const auto segments = fractint("Angle 4\nAxiom [@.5F@IQ4F]F\n", 0).segments();
    ASSERT_EQ(segments.size(), 3u);
    EXPECT_NEAR(segments[0].second.x, 0.5, 1e-9);
    EXPECT_NEAR(segments[1].second.x, 0.75, 1e-9);
    EXPECT_NEAR(segments[2].second.x, 1, 1e-9);
}

TEST(FractintLsystem, HasTwoHeadings) {
    const auto segments = fractint("Angle 4\nAxiom +F\\30DF\n", 0).segments();
    ASSERT_EQ(segments.size(), 3u);
    EXPECT_NEAR(segments[0].second.y, 1, 1e-9);
    EXPECT_NEAR(segments[1].second.x, std::sqrt(3) / 2, 1e-9);
    EXPECT_NEAR(segments[1].second.y, 1.5, 1e-9);
    EXPECT_NEAR(segments[2].second.y, 2.5, 1e-9) << "F goes on as before";
}

TEST(FractintLsystem, ReversesTurnsUpToTheBracket) {
    const auto segments = fractint("Angle 4\nAxiom [!+F]+F\n", 0).segments();
    ASSERT_EQ(segments.size(), 2u);
    EXPECT_NEAR(segments[0].second.y, -1, 1e-9);
    EXPECT_NEAR(segments[1].second.y, 1, 1e-9);
}

TEST(FractintLsystem, HalfTurnsOfOddAngles) {
    const auto segments = fractint("Angle 5\nAxiom |F\n", 0).segments();
    ASSERT_EQ(segments.size(), 1u);
    EXPECT_NEAR(segments[0].second.y, -std::sin(144 * std::acos(-1.0) / 180), 1e-9);
}

TEST(FractintLsystem, ScaledTreesFold) {
    const Imported tree = fractint("Angle 12\nAxiom X\nX=F[@.7+X][@.7-X]\n", 60);
    ASSERT_TRUE(tree.graph) << tree.said();
    EXPECT_EQ(tree.derivation->segments, "1152921504606846975");
    EXPECT_LT(tree.derivation->parts, 200u);
    // Two factors: parts differ in how often each was met, not in the order.
    const Imported uneven = fractint("Angle 12\nAxiom X\nX=F[@.7+X][@.6-X]\n", 40);
    ASSERT_TRUE(uneven.graph) << uneven.said();
    EXPECT_EQ(uneven.derivation->segments, "1099511627775");
    EXPECT_LT(uneven.derivation->parts, 2000u);
}

TEST(FractintLsystem, SaysWhatIsWrong) {
    EXPECT_THAT(fractint("Angle 4\nAxiom F\n+=F\n", 1).said(),
                HasSubstr("a.l:4:1: error: '+' has a fixed meaning"));
    EXPECT_THAT(fractint("Angle 2\nAxiom F\n", 1).said(), HasSubstr("a.l:2:7: error: the angle"));
    EXPECT_THAT(fractint("Angle 4\n", 1).said(), HasSubstr("'Model' has no axiom"));
    EXPECT_THAT(fractint("Angle 4\nAxiom F@F\n", 1).said(), HasSubstr("a.l:3:8: error: '@' needs a number"));
    EXPECT_THAT(fractint("Angle 4\nAxion F\n", 1).said(), HasSubstr("'axion' begins no statement"));
    EXPECT_THAT(fractint("Angle 4\nAxiom F[F\n", 1).said(), HasSubstr("never closed"));
}

} // namespace
} // namespace graftal::testing
