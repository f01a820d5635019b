// Models whose parts lie in each other, and the work that a picture may take: every command comes to an end.

#include "tests/golden/command_line.h"

#include <gmock/gmock.h>

#include "runtime/image/image.h"

namespace graftal {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// Hart's limit of a tree: 3^n branches of 0.9^n.
const char* const tree_limit = R"(
object trunk { cylinder scale: 0.05, 1, 0.05 }
object tree {
    union: trunk, branch_1, branch_2, branch_3
}
object branch_1 { tree rotate: x, 18.95 scale: 0.9 translate: 0, 1, 0 }
object branch_2 { tree rotate: x, 18.95 rotate: y, 94.74 scale: 0.9 translate: 0, 1, 0 }
object branch_3 { tree rotate: x, 18.95 rotate: y, 227.37 scale: 0.9 translate: 0, 1, 0 }
)";

const char* const crowd_in_the_plane = R"(
rifs crowd {
  codes 2d {
    0.7  0.1 -0.1 0.7  0.3  0.1
    0.6 -0.3  0.3 0.6 -0.5  0.2
    0.7  0.2 -0.2 0.7  0.1 -0.6
    0.65 0    0   0.65 0.8  0.4
    0.6  0.3 -0.3 0.6 -0.2 -0.3
    0.7 -0.2  0.2 0.7  0.5 -0.7
  }
}
)";

class Work : public CommandLine {};

TEST_F(Work, WhatLiesInEachOtherIsDrawnByBothEngines) {
    write("tree.inst", tree_limit);
    write("crowd.rifs", crowd_in_the_plane);
    for (const char* const model : {"tree.inst", "crowd.rifs"}) {
        const RunResult native = shell(
            std::string("\"$graftal\" render --engine native --plain-light --size 96x54 -o native.png ") +
            model);
        EXPECT_EQ(native.status, 0) << native.err;
        EXPECT_THAT(native.err, Not(HasSubstr("given up")));
        const RunResult povray = shell(
            std::string("\"$graftal\" render --engine povray --plain-light --size 96x54 -o povray.png ") +
            model);
        EXPECT_EQ(povray.status, 0) << povray.err;
        // Each has a shell of its own: as fine as its octave, or half octave, of sizes asks for.
        const Image a = picture("native.png"), b = picture("povray.png");
        double sum = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::abs(a.pixels[i] - b.pixels[i]);
        EXPECT_LT(255 * sum / static_cast<double>(a.pixels.size()), 4) << model;
    }
}

TEST_F(Work, LessWorkMakesACoarserPictureAndSaysSo) {
    write("tree.inst", tree_limit);
    const RunResult result = shell("\"$graftal\" render --engine native --plain-light --size 160x90 --work "
                                   "0.05 tree.inst -o a.png --threads 1");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("warning: 0.05 seconds of work allow an error of"));
    EXPECT_THAT(result.err, HasSubstr("give them with --work, or ask for less with --error or --steps"));
    EXPECT_EQ(shell("\"$graftal\" render --engine native --plain-light --size 160x90 --work 0.05 tree.inst "
                    "-o b.png --threads 2")
                  .status,
              0);
    EXPECT_EQ(compare_images(picture("a.png"), picture("b.png")).differing, 0u) << "threads decide nothing";
}

// Both maps keep the middle: 2^35 cones lie in each other, and every ray goes into more than it may.
TEST_F(Work, WhereEveryRayMeetsTooMuchFewerAreTraced) {
    write("cones.rifs", "rifs cones {\n"
                        "  map a { rotate <1, 2, 3>, 31 scale 0.7 }\n"
                        "  map b { rotate <3, 1, 2>, 77 scale 0.6, 0.65, 0.7 }\n"
                        "  terminal cone scale 0.96 translate 0, 0.5, 0.3\n"
                        "}\n");
    const RunResult result = shell("\"$graftal\" render --engine native --plain-light --size 1600x900 --work "
                                   "0.001 --steps 35 cones.rifs "
                                   "-o a.png --threads 2");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err,
                HasSubstr("and graftal gives up rays that meet too many parts, by 1 sample per "));
    EXPECT_EQ(picture("a.png").width, 1600);
}

// Copies that lie in each other are drawn as one shell: it has the terminal's own material.
TEST_F(Work, ShellsHaveTheMaterialOfTheTerminal) {
    write("cubes.rifs", "material blue { color: 0.1, 0.1, 0.8  specular: 0  ambient: 0.5 }\n"
                        "camera { location: 0.5, 0.5, 9  look_at: 0.5, 0.5, 0  orthographic  width: 3 }\n"
                        "light { location: 0, 0.475, 900  color: 1, 1, 1 }\n"
                        "rifs m {\n"
                        "  map a { scale 0.7 }\n"
                        "  map b { scale 0.7 translate 0.3, 0, 0 }\n"
                        "  map c { scale 0.7 translate 0, 0.3, 0 }\n"
                        "  map d { scale 0.7 translate 0.3, 0.3, 0 }\n"
                        "  terminal cube scale 0.5, 0.5, 0.002 translate 0.5, 0.5 material blue\n"
                        "}\n");
    for (const std::string error : {"0.5", "8"}) {
        const RunResult result =
            shell("\"$graftal\" render --engine native --plain-light --size 64x36 --error " + error +
                  " cubes.rifs -o a.png");
        ASSERT_EQ(result.status, 0) << result.err;
        const Image image = picture("a.png");
        const float* middle = &image.pixels[image.channels * (18 * 64 + 32)];
        EXPECT_GT(middle[2], 2 * middle[0]) << error;
    }
}

// The points of a shell took all the work that there was, and a little more: no cut was good enough until the
// whole was a box of 12 triangles.
TEST_F(Work, AShellTakesWhatThereIsAndIsNotGivenUpForIt) {
    write("tree.inst", tree_limit);
    write("bush.lsys",
          "lsys bush {\n"
          "  angle 25\n"
          "  steps 24\n"
          "  axiom X(1)\n"
          "  X(s) -> F(s)[+X(s*0.83)]F(s*0.97)[-X(s*0.79)][+X(s*0.71)]F(s*0.9)[-X(s*0.61)]X(s*0.53)\n"
          "}\n");
    for (const std::string model : {"tree.inst", "bush.lsys"}) {
        const RunResult result = graftal("compile --size 320x180 -o a.pov --work 4 " + model);
        ASSERT_EQ(result.status, 0) << result.err;
        const std::size_t at = result.err.rfind("error ");
        ASSERT_NE(at, std::string::npos) << result.err;
        EXPECT_LT(std::strtod(result.err.c_str() + at + 6, nullptr), 5) << result.err;
    }
}

TEST_F(Work, OfPovrayIsSaidBeforeItStarts) {
    write("ball.inst", "object ball { sphere }\n");
    const std::string render = "render --engine povray ball.inst --plain-light -o a.png --size ";
    EXPECT_THAT(graftal(render + "64x36").err, Not(HasSubstr("seconds")));
    EXPECT_THAT(graftal(render + "64x36 --work 0.001").err,
                ContainsRegex("graftal: POV-Ray will take about 0\\.[0-9]+ seconds"));
}

// Rays meet hundreds of boxes of what a short text places: by its length it would be done in an instant.
TEST_F(Work, OfRaysThroughACrowdIsSaidToo) {
    write("crowd.lsys", "lsys crowd {\n"
                        "  width 0.05\n"
                        "  steps 19\n"
                        "  axiom RY+\n"
                        "  R -> /(30)R\n"
                        "  V -> gYRY\n"
                        "  Y -> [&VR]FF/+(30)[V][R[&/]-F]R\n"
                        "}\n");
    EXPECT_THAT(
        graftal("render --engine povray crowd.lsys --plain-light -o a.png --size 64x36 --work 0.3").err,
        HasSubstr("graftal: POV-Ray will take about "));
}

TEST_F(Work, IsAPositiveNumber) {
    write("tree.inst", tree_limit);
    const RunResult result = shell("\"$graftal\" render --work 0 tree.inst");
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr("--work"));
}

/// Kinds of parts were told apart for as long as it took, and left nothing for what is drawn: 950 px.
TEST_F(Work, OfThreeSecondsIsNotSpentOnTellingPartsApart) {
    write("similar.lsys", R"(
lsys similar {
  angle 25
  steps 30
  axiom X(1)
  X(s) -> F(s)[+X(s*0.83)]F(s*0.97)[-X(s*0.79)][+X(s*0.71)]F(s*0.9)[-X(s*0.61)]X(s*0.53)
}
)");
    const RunResult result = graftal("compile --work 3 similar.lsys -o similar.pov");
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string mark = "an error of ";
    const std::size_t at = result.err.find(mark);
    const double error_px = at == std::string::npos ? 0 : std::stod(result.err.substr(at + mark.size()));
    EXPECT_LT(error_px, 100) << result.err;
}

} // namespace
} // namespace graftal
