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

const std::string gasket = "'" + source_path("scenes/hart/sierpinski.inst") + "' ";

class Zoom : public CommandLine {};

TEST_F(Zoom, CommandsOfThePageWork) {
    const std::vector<std::string> commands = commands_of("docs/zoom.md");
    for (std::string words : commands) {
        if (words.starts_with("animate")) words += " --frames 2";
        const RunResult result = graftal(words + " -q --size 48x27 --antialias off --error 2");
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
        {"--at up..left", 2, "--at: 'up..left': a name expected, not '.' at character 4"},
        {"--at ''", 2, "--at: '': a name expected at character 1"},
        {"--zoom 0", 2, "--zoom: '0' is not a number above 0, such as 1e100 or 2^330"},
        {"--zoom big", 2, "is not a number above 0"},
        {"--at down", 1, "error: the address does not exist: 'top' has no part 'down'"},
        {"--at 'up#2'", 1, "'top' has no part 'up#2'"},
        {"--at '(up)*'", 1, "an address without an end is a point"},
        {"--at up.left --zoom 1e40", 1, "the address ends after 2 steps, before the zoom does"},
        {"--at '(up)*' --zoom 2^60 --steps 12", 1, "levels deep, and --steps ends the model after 12"},
        {"--camera 'look_at=0.1,0.2,0' --zoom 1e100", 1, "the zoom needs more digits than the point has"},
    };
    for (const Case& c : cases) {
        const RunResult result =
            graftal("render " + gasket + c.options + std::string(" -o a.png --size 48x27"));
        EXPECT_EQ(result.status, c.status) << c.options;
        EXPECT_THAT(result.err, HasSubstr(c.message)) << c.options;
        EXPECT_EQ(files(), "") << c.options;
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
