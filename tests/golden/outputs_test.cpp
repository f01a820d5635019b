// What an output may be, and what stays where none comes to be.

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/image_files/image_files.h"
#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

class Outputs : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        write("m.rifs",
              "rifs m {\n map a { scale 1/2 tint 1,0,0,0.5 }\n map b { scale 1/2 translate <1,0,0> tint "
              "0,1,0,0.5 }\n map c { scale 1/2 translate <0,1,0> tint 0,0,1,0.5 }\n}\n");
    }
    /// One command a kind of output, without the output.
    static std::vector<std::pair<std::string, std::string>> commands() {
        const std::string size = " m.rifs -q --size 16x12 ";
        return {{"compile" + size, "a.pov"},
                {"render --engine native" + size, "a.png"},
                {"render --engine native" + size, "a.exr"},
                {"points --points 1000" + size, "b.png"},
                {"points --points 1000" + size, "a.ply"},
                {"animate --engine native --frames 2" + size, "a.gif"},
                {"animate --engine native --frames 2" + size, "b.png"},
                {"graph m.rifs -q ", "a.dot"}};
    }
};

TEST_F(Outputs, PipesAndDevicesAreRefused) {
    for (const auto& [command, name] : commands()) {
        for (const std::string make : {"mkfifo ", "ln -s /dev/null "}) {
            ASSERT_EQ(shell(make + name).status, 0);
            const RunResult result = shell("timeout 60 $graftal " + command + "-o " + name);
            EXPECT_EQ(result.status, 3) << command << name << result.err;
            EXPECT_THAT(result.err,
                        HasSubstr("graftal: cannot write '" + name + "': it is not a regular file"));
            EXPECT_EQ(files(), "m.rifs " < name ? "m.rifs " + name : name + " m.rifs") << command;
            std::filesystem::remove(path(name));
        }
        EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    }
}

TEST_F(Outputs, NamesAreOneLineOfText) {
    std::vector<std::pair<std::string, std::string>> all = commands();
    for (const char* ending : {"obj", "usda", "gltf", "xml", "pbrt", "stl", "svg"})
        all.emplace_back("export m.rifs -q --steps 2 ", std::string("a.") + ending);
    for (const auto& [command, name] : all)
        for (const char* bytes : {"\\n", "\\033[31m", "\\377", "\\342\\200\\256", "\\177"}) {
            const RunResult result =
                shell("timeout 60 $graftal " + command + "-o \"$(printf 'x" + bytes + name + "')\"");
            EXPECT_EQ(result.status, 2) << command << bytes;
            EXPECT_THAT(result.err, HasSubstr("a name that graftal writes is in UTF-8, without line ends"))
                << command;
            EXPECT_EQ(result.err.find_first_of("\033\377\342\177"), std::string::npos) << command;
            EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 2) << command;
            EXPECT_EQ(files(), "m.rifs") << command;
        }
}

/// The name of a model that a stranger has sent: graftal reads it, and shows and writes it escaped.
TEST_F(Outputs, NamesOfModelsReachNoFileAndNoTerminalRaw) {
    shell("mkdir in && mv m.rifs \"in/$(printf 'x\\nv 9 9 9\\n\\033[31m\\377.rifs')\"");
    std::vector<std::string> runs = {"check in/*",
                                     "stats in/*",
                                     "stats in/* --json",
                                     "print in/*",
                                     "graph in/*",
                                     "check in/*:none",
                                     "check --root in /none/in/*",
                                     "compile in/* --size 16x12",
                                     "render in/* --engine native --size 16x12",
                                     "render in/* --engine native --size 16x12 -o a.png",
                                     "animate in/* --engine native --size 16x12 --frames 2 -o a.gif",
                                     "points in/* --points 1000 --size 16x12 -o b.png",
                                     "points in/* --points 1000 -o a.ply",
                                     "compile in/* --size 16x12 -o a.pov",
                                     "compile in/* -o a.inc --name Mine"};
    for (const char* ending : {"obj", "ply", "usda", "gltf", "xml", "pbrt", "stl", "svg"})
        runs.push_back(std::string("export in/* --steps 2 -o a.") + ending);
    for (const std::string& run : runs) {
        const RunResult result = shell("timeout 60 $graftal " + run);
        EXPECT_LE(result.status, 3) << run;
        EXPECT_EQ((result.out + result.err).find_first_of("\033\377"), std::string::npos) << run;
        EXPECT_EQ((result.out + result.err).find("\nv 9 9 9"), std::string::npos) << run;
    }
    for (const char* name :
         {"a.obj", "a.mtl", "a.usda", "a.gltf", "a.xml", "a.pbrt", "a.svg", "a.pov", "a.inc"}) {
        const std::string text = read(name);
        EXPECT_NE(text, "") << name;
        EXPECT_EQ(text.find_first_of("\033\377"), std::string::npos) << name;
        EXPECT_EQ(text.find("\nv 9 9 9\n"), std::string::npos) << name;
    }
    for (const char* name : {"a.png", "a.ply", "a.stl"})
        EXPECT_EQ(read(name).find("v 9 9 9\n"), std::string::npos) << name;
    // It has no name of its own for a picture then.
    EXPECT_EQ(shell("$graftal render in/* --engine native -q").status, 2);
}

TEST_F(Outputs, AFolderIsNoFile) {
    shell("mkdir folder");
    for (const auto& [command, name] : commands()) {
        if (command.starts_with("animate")) continue; // its frames have a folder
        for (const char* folder : {"folder", "folder/", "new/"}) {
            const RunResult result = shell("timeout 60 $graftal " + command + "-o " + folder);
            EXPECT_EQ(result.status, 2) << command;
            EXPECT_THAT(result.err, HasSubstr(std::string("'") + folder +
                                              "' is a folder: name a file in it, such as "
                                              "'-o "))
                << command;
        }
    }
    write("k.l", "Koch1 {\n Angle 6\n Axiom F--F--F\n F=F+F--F+F\n}\n");
    shell("mkdir a.lsys");
    for (const char* folder : {"folder", "a.lsys", "deep/er/"}) {
        EXPECT_EQ(graftal(std::string("import -q k.l -o ") + folder).status, 0) << folder;
        EXPECT_TRUE(exists(std::string(folder) + "/Koch1.lsys")) << folder;
    }
    write("bad.es", "r1 {\n");
    EXPECT_EQ(graftal("import -q bad.es -o none/of/it/").status, 1);
    EXPECT_EQ(files(), "a.lsys bad.es deep folder k.l m.rifs");
}

TEST_F(Outputs, FoldersThatWereMadeForNothingAreTakenBack) {
    shell("mkdir bin there");
    write("bin/povray", "#!/bin/sh\nexit 1\n");
    shell("chmod +x bin/povray");
    write("bad.inst", "object top {\n    union: nowhere\n}\n");
    for (const std::string top : {"deep", "there/deep"}) {
        EXPECT_EQ(shell("PATH=\"$PWD/bin:$PATH\" $graftal animate --engine povray m.rifs -q --size 16x12 "
                        "--frames 2 -o " +
                        top + "/er/film/")
                      .status,
                  3);
        EXPECT_EQ(graftal("farm plan bad.inst -q --tiles 9x9 -o " + top + "/er/job").status, 1);
        EXPECT_EQ(graftal("farm plan m.rifs -q --tiles 9x9 --size 20000x20000 -o " + top + "/er/job").status,
                  2);
    }
    EXPECT_EQ(files(), "bad.inst bin m.rifs there");
    EXPECT_EQ(shell("ls -A there").out, "");
}

TEST_F(Outputs, LinksAreWrittenThrough) {
    for (const auto& [command, name] : commands()) {
        std::filesystem::create_directory(path("far"));
        write("far/real", "old");
        ASSERT_EQ(shell("ln -s far/real " + name).status, 0);
        const RunResult result = graftal(command + "-o " + name);
        EXPECT_EQ(result.status, 0) << command << name << result.err;
        EXPECT_TRUE(std::filesystem::is_symlink(path(name))) << name;
        EXPECT_EQ(shell("ls -A far").out, "real\n") << name;
        EXPECT_NE(read("far/real"), "old") << name;
        shell("rm -rf far a.* b.* m_* a_*");
    }
}

TEST_F(Outputs, PalettesAppearWithTheirSceneOrNotAtAll) {
    ASSERT_TRUE(write_image(path("bark.png"), Image{1, 1, 3, {0.5f, 0.5f, 0.5f}}, SampleFormat::srgb8).ok());
    write("t.inst",
          "material m { texture: \"bark.png\" }\nobject a {\n scatter: cone over: disc 9 count: 900\n"
          "  material: m\n}\n");
    ASSERT_EQ(graftal("compile t.inst -q -o a.pov").status, 0);
    ASSERT_NE(files(), "a.pov bark.png m.rifs t.inst") << "a palette beside it";
    shell("rm -f a* *_1.png");
    const RunResult result = shell("ulimit -f 40\n$graftal compile t.inst -q -o a.pov");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("cannot write 'a.pov': File too large"));
    EXPECT_EQ(files(), "bark.png m.rifs t.inst");
}

TEST_F(Outputs, TheSceneOnStandardOutputGoesByWayOfTmpdir) {
    write("b.inst", "object a { sphere }\n");
    EXPECT_EQ(graftal("compile b.inst -o -").status, 0);
    const RunResult result = shell("TMPDIR=$PWD/none $graftal compile b.inst -o -");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("cannot write 'a temporary file': No such file or directory"));
    EXPECT_EQ(temporary_files(), "");
}

TEST_F(Outputs, TwoRunsDoNotShareTheFramesOfAnAnimation) {
    const std::string command = "$graftal animate m.rifs -q --engine native --size 16x12 --frames 2 -o ";
    const RunResult held = shell("mkdir a.frames frames\nflock a.frames " + command +
                                 "a.gif\necho $?\nflock frames " + command + "frames/\necho $?");
    EXPECT_EQ(held.out, "3\n3\n");
    EXPECT_THAT(held.err,
                HasSubstr("graftal: another run of graftal is working on the frames in 'a.frames'\n"));
    EXPECT_EQ(files(), "a.frames frames m.rifs");
    // Together, both are done or told so, and no frame is lost to the other's tidying.
    const RunResult both = shell(command + "a.gif & " + command + "a.gif; echo $?; wait $!; echo $?");
    EXPECT_THAT(both.out, testing::MatchesRegex("[03]\n[03]\n"));
    EXPECT_NE(both.out, "3\n3\n");
    EXPECT_EQ(files(), "a.gif frames m.rifs");
}

TEST_F(Outputs, APictureOfAnotherSizeIsNone) {
    std::filesystem::create_directory(path("bin"));
    ASSERT_TRUE(
        write_image(path("bin/still.png"), Image{2, 3, 1, std::vector<float>(6, 0.5f)}, SampleFormat::srgb8)
            .ok());
    write("bin/povray",
          "#!/bin/sh\ncp '" + path("bin/still.png") + "' picture.png\necho 'POV-Ray finished' >&2\n");
    const RunResult result = shell("chmod +x bin/povray; PATH=$PWD/bin:$PATH $graftal render --engine povray "
                                   "m.rifs -q --size 16x12 -o a.png");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("graftal: POV-Ray wrote a picture of 2 x 3 pixels, not 16 x 12\n"));
    EXPECT_EQ(files(), "bin m.rifs");
}

TEST_F(Outputs, TimesThatALanguageDoesNotKnowHaveAPlace) {
    const RunResult result = graftal("check --steps 7.5 m.rifs");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(
        result.err,
        testing::StartsWith("m.rifs:1:1: error: only L-systems have times between two steps, such as 7.5"));
}

} // namespace
} // namespace graftal
