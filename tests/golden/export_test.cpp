// The command `export`: what it says, and what it leaves.

#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class Export : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        write("m.rifs", model);
    }

    static constexpr const char* maps = " map a { scale 1/2 }\n map b { scale 1/2 translate <1, 0, 0> }\n "
                                        "map c { scale 1/2 translate <0, 1, 0> }\n";
    const std::string model = std::string("rifs m {\n") + maps + " terminal cube\n}\n";
    const std::string flat = std::string("rifs m {\n") + maps + "}\n";
};

TEST_F(Export, WritesEachFormatAndSaysWhat) {
    const std::pair<const char*, const char*> cases[] = {
        {"a.obj", "a.obj: 27 primitives: 324 triangles, 1 materials\n"},
        {"b.ply", "b.ply: 27 primitives: 324 triangles\n"},
        {"c.stl", "c.stl: 27 primitives: 324 triangles, "},
        {"d.usda", "d.usda: 27 primitives: "},
        {"e.glb", "e.glb: 27 primitives: "},
        {"f.gltf", "f.gltf: 27 primitives: "},
        {"g.pbrt", "g.pbrt: 27 primitives: "},
        {"h.xml", "h.xml: 27 primitives: "},
    };
    for (const auto& [name, said] : cases) {
        const RunResult result = graftal(std::string("export m.rifs --steps 3 -o ") + name);
        EXPECT_EQ(result.status, 0) << name << result.err;
        EXPECT_THAT(result.err, StartsWith(said));
        EXPECT_EQ(result.out, "");
    }
    EXPECT_EQ(files(), "a.mtl a.obj b.ply c.stl d.usda e.glb f.gltf g.pbrt h.serialized h.xml m.rifs");
    EXPECT_EQ(temporary_files(), "");
}

TEST_F(Export, RefusesWrongCommandLines) {
    const std::pair<const char*, const char*> cases[] = {
        {"export m.rifs", "graftal: name the file with '-o FILE'; its ending says the format: .usda, "},
        {"export m.rifs -o a.fbx", "graftal: 'a.fbx': the name must end in .usda, "},
        {"export m.rifs -o a", "graftal: 'a': the name must end in .usda, "},
        {"export m.rifs -o a.obj --unit 3mm",
         "graftal: --unit is for .usda, .gltf, .glb, .stl, .svg, not for .obj"},
        {"export m.rifs -o a.stl --unit 3",
         "graftal: --unit: '3' is not a length such as 25mm, 1cm, 2m or 1in"},
        {"export m.rifs -o a.stl --unit 0mm", "graftal: --unit: '0mm' is not a length"},
        {"export m.rifs -o a.stl --unit nanmm", "graftal: --unit: 'nanmm' is not a length"},
        {"export m.rifs -o a.stl --levels 3", "graftal: --levels is for .usda, not for .stl"},
        {"export m.rifs -o a.usda --levels 1", "graftal: --levels: '1' is not a whole number from 2 to 1000"},
        {"export m.rifs -o a.usda --nodes 3", "graftal: --nodes is for .gltf, .glb, not for .usda"},
        {"export m.rifs -o a.obj --plotter", "graftal: --plotter is for .svg, not for .obj"},
        {"export m.rifs -o a.ply --instancing", "graftal: --instancing is for .gltf, .glb, not for .ply"},
        {"export m.rifs -o a.obj --irradiance",
         "graftal: --irradiance is for .csv, .json or .mtg, not for .obj"},
        {"export m.rifs -o a.csv --unit 3mm",
         "graftal: --unit is for .usda, .gltf, .glb, .stl, .svg, not for .csv"},
        {"export m.rifs -o a.json --nodes 3", "graftal: --nodes is for .gltf, .glb, not for .json"},
        {"export m.rifs -o a.mtg --error 3", "graftal: --error, at and zoom are for .usda, "},
        {"export m.rifs -o a.mtg --at m", "graftal: --error, at and zoom are for .usda, "},
        {"export m.rifs -o a.ply --limit 0", "graftal: --limit: '0' is not a number of bytes"},
    };
    for (const auto& [command, said] : cases) {
        const RunResult result = graftal(command);
        EXPECT_EQ(result.status, 2) << command;
        EXPECT_THAT(result.err, HasSubstr(said)) << command;
    }
    EXPECT_EQ(files(), "m.rifs");
}

TEST_F(Export, WritesAModelThatChangesAsUsd) {
    const RunResult result = graftal("animate m.rifs --steps 1..3 --frames 6 --fps 12 -o g.usda");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("g.usda: 6 frames, 12 per second"));
    EXPECT_EQ(files(), "g.frames g.usda m.rifs");
    for (const auto& [state, primitives] : {std::pair("0001", 3), {"0003", 9}, {"0005", 27}}) {
        const std::string name = fmt::format("g.frames/frame_{}.usda", state), text = read(name);
        EXPECT_EQ(graftal(fmt::format("export m.rifs --steps {} -o once.usda", primitives == 3   ? 1
                                                                               : primitives == 9 ? 2
                                                                                                 : 3))
                      .status,
                  0);
        EXPECT_EQ(text.substr(text.find("def Xform")),
                  read("once.usda").substr(read("once.usda").find("def Xform")));
    }
    const std::string whole = read("g.usda");
    EXPECT_THAT(whole, HasSubstr(" endTimeCode = 6\n timeCodesPerSecond = 12\n"));
    EXPECT_THAT(whole, HasSubstr("\"state_1\" (\n  prepend references = @g.frames/frame_0001.usda@\n )\n {\n"
                                 "  token visibility.timeSamples = { 1: \"inherited\", 3: \"invisible\", }"));
    EXPECT_THAT(whole, HasSubstr("{ 2: \"invisible\", 3: \"inherited\", 5: \"invisible\", }"));
    EXPECT_THAT(whole, HasSubstr("{ 4: \"invisible\", 5: \"inherited\", }"));
    EXPECT_EQ(whole.find("state_4"), std::string::npos);
}

TEST_F(Export, RefusesAnimationsThatUsdCannotShow) {
    const std::pair<const char*, const char*> cases[] = {
        {"animate m.rifs -o a.usda", "a .usda shows a model that changes"},
        {"animate m.rifs --steps 1..3 --turn 90 -o a.usda", "--turn: whoever reads a .usda turns the camera"},
        {"animate m.rifs --steps 1..3 --quality best -o a.usda", "--quality: a .usda holds the model"},
        {"animate m.rifs --steps 1..3 --zoom 2 -o a.usda", "--zoom: a .usda holds the model"},
    };
    for (const auto& [command, said] : cases) {
        const RunResult result = graftal(command);
        EXPECT_NE(result.status, 0) << command;
        EXPECT_THAT(result.err, HasSubstr(said)) << command;
    }
    EXPECT_EQ(files(), "m.rifs");
}

TEST_F(Export, RefusesModelsThatDoNotFit) {
    const std::pair<const char*, const char*> cases[] = {
        {"export m.rifs --steps 80 --error 0 -o a.ply",
         "error: 'a.ply' would have 1.47e+38 primitives with 1.77e+39 triangles"},
        {"export m.rifs --steps 8 --error 0 --limit 1K -o a.stl",
         "error: 'a.stl' would have 6561 primitives with 78732 triangles, 3.75 MiB"},
        {"export m.rifs --steps 80 --error 0 -o a.glb", "error: with "},
        {"export m.rifs --steps 80 --limit 1K -o a.usda", "error: 'a.usda' would have "},
        {"export m.rifs --error 0 -o a.usda", "error: the recursion has no end"},
        {"export cube.inst -o a.svg", "error: the model is in no plane"},
        {"export none.rifs -o a.obj", "cannot open 'none.rifs'"},
    };
    write("cube.inst", "object m { cube }\n");
    for (const auto& [command, said] : cases) {
        const RunResult result = graftal(command);
        EXPECT_NE(result.status, 0) << command;
        EXPECT_THAT(result.err, HasSubstr(said)) << command;
    }
    EXPECT_EQ(files(), "cube.inst m.rifs");
}

TEST_F(Export, WritesAModelThatWouldBeTooLargeCoarser) {
    for (const std::string ending : {"obj", "ply", "stl", "glb", "gltf", "pbrt", "svg", "usda"}) {
        for (const char* const depth : {"", " --steps 80"}) {
            const std::string name = "a." + ending, command = "export m.rifs --limit 64K -o " + name + depth;
            write("m.rifs", ending == "svg" ? flat : model);
            const RunResult result = graftal(command);
            EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
            if (ending != "usda" && ending != "svg") { // which nest parts, so that the whole model fits
                EXPECT_THAT(result.err, HasSubstr("; so graftal leaves out parts smaller than ")) << command;
            }
            EXPECT_LE(read(name).size(), 64u << 10) << command;
            EXPECT_GT(read(name).size(), 1000u) << command;
        }
    }
    // What no error mends is refused, with nothing left behind.
    write("m.rifs", model);
    std::filesystem::remove(path("a.usda"));
    const RunResult refused = graftal("export m.rifs --limit 1K -o a.usda");
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("--limit"));
    EXPECT_FALSE(exists("a.usda"));
}

TEST_F(Export, AFolderThatIsNotThereIsTheEnvironments) {
    for (const char* name :
         {"no/a.obj", "no/a.ply", "no/a.stl", "no/a.usda", "no/a.glb", "no/a.pbrt", "no/a.xml"}) {
        const RunResult result = graftal(std::string("export m.rifs --steps 2 -o ") + name);
        EXPECT_EQ(result.status, 3) << name;
        EXPECT_THAT(result.err, HasSubstr("cannot write 'no/a.")) << result.err;
    }
    EXPECT_EQ(files(), "m.rifs");
}

/// With smaller models and pictures, and nobody asked what they take.
TEST_F(Export, CommandsOfThePageWork) {
    const std::vector<std::string> commands = commands_of("docs/export.md");
    EXPECT_GE(commands.size(), 8u);
    for (const std::string& command : commands) {
        const RunResult result = graftal(command);
        EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
    }
}

TEST_F(Export, ASquareOfStrokes) {
    write("square.lsys", "lsys square {\n steps 0\n angle 90\n axiom F+F+F+F\n}\n");
    ASSERT_EQ(graftal("export square.lsys --plotter --unit 10mm -o p.svg").status, 0);
    const std::string text = read("p.svg");
    EXPECT_EQ(text.find("<path"), text.rfind("<path")) << text; // one stroke
}

} // namespace
} // namespace graftal
