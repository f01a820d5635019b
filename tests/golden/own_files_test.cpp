// Files that a command must not write over: those of the model itself. And options without a use.

#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

class OwnFiles : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        write("leaf.rifs", "rifs leaf {\n  map a { scale 1/2 }\n  map b { scale 1/2 translate <1, 0, 0> }\n"
                           "  map c { scale 1/2 translate <0, 1, 0> }\n}\n");
    }
};

/// The picture of a card has the card's name, and so has the picture that `render` makes of it.
TEST_F(OwnFiles, AreNotDrawnOverByANameThatNobodyGave) {
    ASSERT_EQ(graftal("points leaf.rifs --card card.inst --points 1e4 -q").status, 0);
    const std::string card = read("card.png");
    for (const std::string command : {"render card.inst --size 32x24 --plain-light", "points card.inst"}) {
        const RunResult result = graftal(command);
        EXPECT_EQ(result.status, 1) << command;
        EXPECT_THAT(result.err,
                    HasSubstr("error: the model uses 'card.png', whose name its picture would have"));
        EXPECT_THAT(result.err, HasSubstr("-o FILE"));
        EXPECT_EQ(read("card.png"), card) << command;
    }
    EXPECT_EQ(graftal("render card.inst --size 32x24 --plain-light -o drawn.png -q").status, 0);
    EXPECT_EQ(read("card.png"), card);
    // Whoever names it means it.
    EXPECT_EQ(graftal("render card.inst --size 32x24 --plain-light -o ./card.png -q").status, 0);
    EXPECT_NE(read("card.png"), card);
}

TEST_F(OwnFiles, AModelIsNotItsCard) {
    write("flat.inst", "object flat {\n  cube scale: 1, 1, 0.001\n}\n");
    const std::string model = read("flat.inst");
    for (const std::string name : {"flat.inst", "./flat.inst"}) {
        const RunResult result = graftal("points flat.inst --points 1e3 --card " + name);
        EXPECT_EQ(result.status, 2) << name;
        EXPECT_THAT(result.err, HasSubstr("is the model: name another file"));
    }
    EXPECT_EQ(read("flat.inst"), model);
    EXPECT_EQ(files(), "flat.inst leaf.rifs");
}

TEST_F(OwnFiles, ADrawingIsNotItsLsystem) {
    write("curve.lsys", "lsys curve {\n  steps 2\n  axiom F\n  F -> F+F--F+F\n}\n");
    const std::string drawing = read("curve.lsys");
    const RunResult result = graftal("fit ./curve.lsys -o curve.lsys");
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr("is the drawing"));
    EXPECT_EQ(read("curve.lsys"), drawing);
}

TEST_F(OwnFiles, OptionsThatNothingAsksForAreRefused) {
    const std::pair<const char*, const char*> commands[] = {
        {"export leaf.rifs --steps 2 -o leaf.obj --samples 8", "--samples needs --irradiance"},
        {"stats leaf.rifs --samples 8", "--samples needs --irradiance"},
        {"points leaf.rifs --card card.inst --ground '#ff0000'", "leave --ground out"},
        {"fit curve.svg --threshold 0.3", "--threshold and --light are for pictures"},
        {"fit curve.svg --light", "--threshold and --light are for pictures"}};
    for (const auto& [command, words] : commands) {
        const RunResult result = graftal(command);
        EXPECT_EQ(result.status, 2) << command;
        EXPECT_THAT(result.err, HasSubstr(words)) << command;
    }
    EXPECT_EQ(files(), "leaf.rifs");
}

} // namespace
} // namespace graftal
