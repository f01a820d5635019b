// The command line of the deep zoom: addresses and factors, right and wrong, and the page about them.

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

class Zoom : public CommandLine {};

TEST_F(Zoom, CommandsOfThePageWork) {
    const std::vector<std::string> commands = commands_of("docs/zoom.md");
    for (std::string words : commands) {
        if (words.starts_with("animate")) words += " --frames 2";
        const RunResult result = graftal(words + " -q --size 48x27 --antialias off --error 2 --plain-light");
        EXPECT_EQ(result.status, 0) << words << "\n" << result.err;
        EXPECT_EQ(result.err, "") << words;
    }
    EXPECT_GE(commands.size(), 6u);
}

TEST_F(Zoom, WrongAddressesAndFactors) {
    struct Case {
        const char* options;
        int status;
        const char* message;
    };
    const Case cases[] = {
        {"--at up..left", 2, "--at: 'up..left': expected a name, not '.' at character 4"},
        {"--at ''", 2, "--at: '': expected a name at character 1"},
        {"--zoom 0", 2, "--zoom: '0' is not a number of at least 1e-100, such as 1e100 or 2^330"},
        {"--zoom big", 2, "is not a number of at least 1e-100"},
        {"--zoom 2^-1080", 2, "is not a number of at least 1e-100"},
        {"--zoom 1e-320", 2, "is not a number of at least 1e-100"},
        {"--at down", 1, "error: the address does not exist: 'top' has no part 'down'"},
        {"--at 'up#2'", 1, "'top' has no part 'up#2'"},
        {"--at '(up)*'", 1, "an endless address is a point"},
        {"--at up.left --zoom 1e40", 1, "the address ends after 2 steps, before the zoom does"},
        {"--at '(up)*' --zoom 2^60 --steps 12", 1, "levels deep, but --steps ends the model after 12"},
        {"--camera 'look_at=0.1,0.2,0' --zoom 1e100", 1, "the zoom needs more digits than the point has"},
    };
    for (const Case& c : cases) {
        const RunResult result =
            graftal("render --engine povray " + gasket + c.options + std::string(" -o a.png --size 48x27"));
        EXPECT_EQ(result.status, c.status) << c.options;
        EXPECT_THAT(result.err, HasSubstr(c.message)) << c.options;
        EXPECT_EQ(files(), "") << c.options;
    }
}

/// Nothing recurs there, so no address leads deeper.
TEST_F(Zoom, OfAModelThatEndsIsToldToBeTooDeep) {
    write("m.inst", "object m { union: cube  union: sphere translate: 2, 0, 0 }\n");
    const RunResult result = graftal("render m.inst --zoom 1e40 -o a.png --size 48x27");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("hint: zoom in less: this model does not recur"));
}

/// A small model, seen from far away.
TEST_F(Zoom, EverySmallZoomIsDrawnOrRefused) {
    write("m.inst", "object m { instance: ball scale: 1e-90 }\nobject ball { sphere }\n");
    for (const std::string command : {"render", "export", "compile", "points"}) {
        const std::string options = command == "render"    ? " --engine native -q -o m.png"
                                    : command == "export"  ? " -q -o m.usda"
                                    : command == "compile" ? " -q -o m.pov"
                                                           : " -q --points 100 -o m.png";
        for (const std::string zoom : {"1e-9", "1e-11", "1e-100"}) {
            const RunResult result = graftal(command + " m.inst --size 9x9 --zoom " + zoom + options);
            EXPECT_TRUE(result.status == 0 || result.status == 1) << command << " " << zoom << result.err;
        }
    }
}

/// Of crushed maps countless parts may come near and none does: the search for neighbours did not end.
TEST_F(Zoom, AmongCrushedMapsItEnds) {
    write("m.rifs", R"(rifs m {
  map a { matrix 0.12530522121342638, -0.10434704629109907, -0.43331934167062142, 2.1807018740614823, 0.15237430013294156, 0.31471548414732314, 0.16508220815435828, 0.21801036242921693, -0.27881597264801722, -0.28343765869193055, 0.15618229111733842, -1.6036217124055874 }
  map b { matrix 0.31353, -0.25404, -0.37345, 0.97506, -0.31418, -0.47838, 0.28354, 1.5743, -0.54618, 0.12935, -0.37748, -1.3945 }
  map c { matrix 0.67658948873989189, 0.023736769384127675, -0.22783587448582066, 0.68763892446115138, -0.089480546099189512, -0.003142018661442, 0.030131231587836718, 0.0009492226227420219, -0.21241094404053734, -0.007451500191454229, 0.071524545986890162, 1.1386473317967571 }
  map d { matrix 0.068377548538807911, -0.27182666837423525, 0.011846843087181707, 2.561866604596724, -0.083705693423997321, 0.33276180344028339, -0.014502519984927294, -0.35948691711370795, -0.14111609024869881, 0.56098980523907271, -0.024449243667145126, 0.30266634928820135 }
  map e { matrix -0.086623, -0.31469, 0.4146, -0.66129, -0.26238, 0.30969, 0.26248, -0.19437, -0.5183, -0.10418, -0.20217, -1.2195 }
}
)");
    const RunResult result = graftal("compile m.rifs --size 64x36 --at '(a.d.c.c)*' --zoom 8.5e24 -o a.pov");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("parts may reach this place"));
    EXPECT_THAT(result.err, HasSubstr("zoom in less"));
}

/// The second power of a map that crushes to a line and turns it aside is a point.
TEST_F(Zoom, LeavesOutWhatIsCrushedToAPoint) {
    write("m.rifs", "rifs m {\n  codes 2d {\n    0 0 0.5 0    0 0\n    0.5 0 0 0.5  0.2 0.2\n    0.5 0 0 0.5 "
                    " -0.2 0.2\n  }\n}\n");
    for (const char* const zoom : {"4", "40", "400"}) {
        const RunResult result =
            graftal(fmt::format("compile m.rifs --at w1 --steps 12 --size 64x36 --zoom {} -o a.pov", zoom));
        EXPECT_TRUE(result.status == 0 || result.status == 1) << result.err;
        EXPECT_THAT(result.err, ::testing::Not(HasSubstr("internal error")));
    }
}

TEST_F(Zoom, NearerIsDeeper) {
    const RunResult result =
        graftal("compile " + gasket + "--at '(up)*' --zoom 1e1000 --size 320x200 -o a.pov");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(files(), "a.pov");
}

TEST_F(Zoom, OutOfSightIsLeftOutWhenAsked) {
    const auto size = [&](const std::string& options) {
        const RunResult result =
            graftal("compile " + gasket + "--at '(up)*' --zoom 4 --size 320x200 " + options);
        EXPECT_EQ(result.status, 0) << result.err;
        return result.out.size();
    };
    EXPECT_LT(size("--visible-only"), size(""));
}

} // namespace
} // namespace graftal
