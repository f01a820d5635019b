// `render --watch`: pictures that follow the files of a model.

#include "tests/golden/background_run.h"
#include "tests/golden/command_line.h"

#include <csignal>

#include <gmock/gmock.h>

namespace graftal {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

const std::string ball = "object m { instance: sphere }\n";
const std::string two_balls = "object m { instance: sphere  instance: sphere translate: 3, 0, 0 }\n";
const std::string wrong = "object m { instance: sphre }\n";

class Watch : public CommandLine {
  protected:
    BackgroundRun start(std::vector<std::string> more = {"--size", "96x54", "--plain-light"}) const {
        more.insert(more.begin(), {"render", "m.inst", "--watch", "-o", "m.png"});
        return {path("."), more};
    }

    /// As editors do that write beside the file first.
    void replace(const std::string& name, const std::string& text) const {
        write(name + ".new", text);
        ASSERT_EQ(shell("mv '" + name + ".new' '" + name + "'").status, 0);
    }

    /// The run draws what a new `render` of the files draws, byte for byte. Whenever it is looked at
    /// meanwhile, the picture is whole.
    void expect_follows(BackgroundRun& run, const std::string& options = small) const {
        ASSERT_EQ(graftal("render m.inst --engine native -q -o ../new.png" + options).status, 0);
        const std::string wanted = read("../new.png");
        EXPECT_TRUE(run.wait_until([&] {
            if (!exists("m.png")) return false;
            EXPECT_GT(picture("m.png").width, 0);
            return read("m.png") == wanted;
        })) << run.messages();
    }

    static void expect_says(BackgroundRun& run, const std::string& text) {
        EXPECT_TRUE(run.wait_until([&] { return run.messages().find(text) != std::string::npos; }))
            << text << "\n"
            << run.messages();
    }
};

TEST_F(Watch, FollowsTheModelThatIsReplacedOrWrittenAnew) {
    write("m.inst", ball);
    BackgroundRun run = start();
    expect_follows(run);
    replace("m.inst", two_balls);
    expect_follows(run);
    write("m.inst", ball);
    expect_follows(run);
    expect_says(run, "m.inst changed: m.png: 4 samples per pixel, error 0.5 px in ");
    run.send(SIGTERM);
    EXPECT_EQ(run.wait(), 128 + SIGTERM);
    EXPECT_THAT(run.messages(), EndsWith("graftal: interrupted\n"));
    EXPECT_EQ(files(), "m.inst m.png");
    EXPECT_EQ(temporary_files(), "");
}

TEST_F(Watch, FollowsUsedModelsTexturesAndMeshes) {
    ASSERT_EQ(shell("mkdir parts; cp '" + source_path("tests/golden/textured/leaf.png") + "' parts/").status,
              0);
    write("parts/part.inst", ball);
    write("parts/mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("m.inst", "use part = \"parts/part.inst\"\nmaterial bark { texture: \"parts/leaf.png\" }\n"
                    "object m { instance: part  instance: cube translate: 2, 0, 0  material: bark\n"
                    "  instance: mesh \"parts/mesh.obj\" translate: 0, 2, 0 }\n");
    BackgroundRun run = start();
    expect_follows(run);
    replace("parts/part.inst", two_balls);
    expect_follows(run);
    expect_says(run, "parts/part.inst changed: m.png: ");
    ASSERT_EQ(shell("cp '" + source_path("scenes/plants/bark.png") + "' parts/leaf.png").status, 0);
    expect_follows(run);
    expect_says(run, "parts/leaf.png changed: m.png: ");
    write("parts/mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    expect_follows(run);
    expect_says(run, "parts/mesh.obj changed: m.png: ");
}

TEST_F(Watch, AWrongTextKeepsThePicture) {
    write("m.inst", ball);
    BackgroundRun run = start();
    expect_follows(run);
    const std::string before = read("m.png");
    replace("m.inst", wrong);
    expect_says(run, "m.inst changed: no new m.png");
    EXPECT_THAT(run.messages(), HasSubstr("m.inst:1:22: error: unknown object 'sphre'\n"));
    EXPECT_EQ(read("m.png"), before);
    write("m.inst", two_balls);
    expect_follows(run);
}

TEST_F(Watch, WaitsForFilesThatAreNotThere) {
    BackgroundRun run = start();
    expect_says(run, "graftal: cannot open 'm.inst': No such file or directory\nno new m.png");
    write("m.inst", "use part = \"later/part.inst\"\nobject m { instance: part }\n");
    expect_says(run, "m.inst changed: no new m.png");
    ASSERT_EQ(shell("mkdir later").status, 0);
    write("later/part.inst", two_balls);
    expect_follows(run);
    ASSERT_EQ(shell("rm m.inst").status, 0);
    expect_says(run, "No such file or directory\nm.inst changed: no new m.png");
    EXPECT_TRUE(run.running());
    write("m.inst", ball);
    expect_follows(run);
}

TEST_F(Watch, OptionsCountAsInRender) {
    const std::string options = " --set a=3 --size 64x64 --antialias off --camera 'location=0,0,9' ";
    write("m.inst", "let a = 1\nobject m { instance: sphere scale: a }\n");
    BackgroundRun run =
        start({"--set", "a=3", "--size", "64x64", "--antialias", "off", "--camera", "location=0,0,9"});
    expect_follows(run, options);
    replace("m.inst", "let a = 1\nobject m { instance: cube scale: a }\n");
    expect_follows(run, options);
}

/// Without the change, and without the signal, the picture would take hours.
TEST_F(Watch, AChangeEndsThePictureUnderWayAndDraftsComeFirst) {
    write("m.inst", ball);
    BackgroundRun run = start({"--plain-light", "--antialias", "9", "--work", "1e6", "--threads", "1"});
    ASSERT_TRUE(run.wait_until([&] { return exists("m.png"); })) << run.messages();
    const int width = picture("m.png").width;
    replace("m.inst", two_balls);
    // Finer pictures of the one ball may come first; the picture of two is wider.
    EXPECT_TRUE(run.wait_until([&] { return picture("m.png").width > width; })) << run.messages();
    EXPECT_EQ(run.messages(), "") << "no picture is finished";
    run.send(SIGINT);
    EXPECT_EQ(run.wait(), 128 + SIGINT);
    EXPECT_THAT(run.messages(), AllOf(HasSubstr("m.inst changed: m.png: unfinished: 1 sample per "),
                                      EndsWith("graftal: interrupted\n")));
    EXPECT_EQ(files(), "m.inst m.png");
}

TEST_F(Watch, AModelMayUseItsOwnPicture) {
    write("m.inst", "material bark { texture: \"m.png\" }\nobject m { instance: cube  material: bark }\n");
    ASSERT_EQ(shell("cp '" + source_path("tests/golden/textured/leaf.png") + "' m.png").status, 0);
    const std::string before = read("m.png");
    BackgroundRun run = start();
    EXPECT_TRUE(run.wait_until([&] { return read("m.png") != before; })) << run.messages();
    expect_says(run, "m.png: 4 samples");
    const std::string picture = read("m.png");
    write("m.inst", wrong); // which is the first change to be seen
    expect_says(run, "m.inst changed: no new m.png");
    EXPECT_EQ(read("m.png"), picture);
    EXPECT_THAT(run.messages(), Not(HasSubstr("m.png changed")));
}

TEST_F(Watch, WhatItCannotDoIsRefused) {
    write("m.inst", ball);
    const struct {
        std::string arguments, message;
        int status;
    } cases[] = {
        {"m.inst --watch --engine povray",
         "--watch draws with '--engine native': leave out '--engine povray'", 2},
        {"- --watch -o m.png <m.inst", "--watch: standard input does not change", 2},
        {"m.inst --watch -o -", "name their file with '-o FILE'", 2},
        {"m.inst --watch -o none/m.png", "cannot write 'none/m.png'", 3},
    };
    for (const auto& [arguments, message, status] : cases) {
        const RunResult result = graftal("render " + arguments);
        EXPECT_EQ(result.status, status) << arguments;
        EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    }
    EXPECT_EQ(files(), "m.inst");
}

#ifdef GRAFTAL_FAULT_SHIM
TEST_F(Watch, WithoutTheKernelsHelpItEnds) {
    write("m.inst", ball);
    for (const std::string fault : {"watch:1", "watch:2", "thread:1"}) {
        const RunResult result =
            shell("head -c 4096 /dev/zero >../record\ntimeout 60 env LD_PRELOAD='" GRAFTAL_FAULT_SHIM
                  "' FAULTS_RECORD=../record FAULTS=" +
                  fault + " \"$graftal\" render m.inst --watch -q --size 16x12 --threads 1");
        EXPECT_EQ(result.status, 3) << fault;
        EXPECT_THAT(result.err, HasSubstr("graftal: cannot watch ")) << fault;
    }
}
#endif

} // namespace
} // namespace graftal
