// --root: models of strangers read no other files.

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

class Root : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        for (const char* folder : {"room", "room/parts", "out"})
            std::filesystem::create_directory(path(folder));
        for (const char* leaf : {"room/parts/leaf.inst", "out/leaf.inst"})
            write(leaf, "object leaf { sphere }\n");
        for (const char* picture : {"room/bark.png", "out/bark.png"})
            ASSERT_TRUE(
                write_image(path(picture), Image{1, 1, 3, {0.5f, 0.5f, 0.5f}}, SampleFormat::srgb8).ok());
        ASSERT_EQ(
            shell(
                "ln -s ../out/leaf.inst room/link.inst; ln -s ../out room/way; ln -s nowhere room/lost.inst; "
                "ln -s parts/leaf.inst room/inner.inst; ln -s $PWD/room entrance; ln -s ../out/bark.png "
                "room/bark_link.png")
                .status,
            0);
    }
    /// A model in the folder that names a file, in each language.
    void write_users(const std::string& used) const {
        write("room/a.inst", "use part = \"" + used + "\"\nobject a { part }\n");
        write("room/a.rifs",
              "use part = \"" + used + "\"\nrifs m {\n condense part\n map a { scale 1/2 }\n}\n");
        write("room/a.lsys", "use part = \"" + used + "\"\nlsys m {\n steps 0\n axiom ~part\n}\n");
    }
};

TEST_F(Root, UsesStayInside) {
    for (const std::string used : {"../out/leaf.inst", "link.inst", "way/leaf.inst", "/etc/passwd",
                                   "lost.inst", "../out/none.inst", "parts/../../out/leaf.inst"}) {
        write_users(used);
        for (const std::string name : {"a.inst", "a.rifs", "a.lsys"}) {
            const RunResult result = graftal("check --root room room/" + name);
            EXPECT_EQ(result.status, 1) << used;
            EXPECT_THAT(result.err, testing::StartsWith("room/" + name + ":1:12: error: '")) << used;
            EXPECT_THAT(result.err, HasSubstr("' leads out of the root folder 'room'\n")) << used;
        }
    }
    for (const std::string used : {"parts/leaf.inst", "inner.inst", "parts/../inner.inst"}) {
        write_users(used);
        for (const std::string name : {"a.inst", "a.rifs", "a.lsys"})
            for (const std::string root : {"room", "entrance", "$PWD/room", "room/parts/.."})
                EXPECT_EQ(graftal("check -q --root " + root + " room/" + name).err, "") << used << root;
    }
}

TEST_F(Root, TexturesStayInside) {
    for (const std::string picture :
         {"../out/bark.png", "bark_link.png", "way/bark.png", "/etc/passwd", "bark.png"}) {
        write("room/t.inst",
              "material m { texture: \"" + picture + "\" }\nobject a { sphere material: m }\n");
        const RunResult result = graftal("check -q --root room room/t.inst");
        EXPECT_EQ(result.status, picture == "bark.png" ? 0 : 1) << picture << result.err;
        if (result.status == 0) continue;
        EXPECT_THAT(result.err, HasSubstr("room/t.inst:1:23: error: '")) << picture;
        EXPECT_THAT(result.err, HasSubstr("leads out of the root folder 'room'")) << picture;
    }
}

TEST_F(Root, EnvironmentsStayInside) {
    for (const std::string picture : {"../out/bark.png", "bark_link.png", "/etc/passwd", "bark.png"}) {
        write("room/t.inst", "sky { environment: \"" + picture + "\" }\nobject a { sphere }\n");
        const RunResult result = graftal("check -q --root room room/t.inst");
        EXPECT_EQ(result.status, picture == "bark.png" ? 0 : 1) << picture << result.err;
        if (result.status == 0) continue;
        EXPECT_THAT(result.err, HasSubstr("room/t.inst:1:20: error: '")) << picture;
        EXPECT_THAT(result.err, HasSubstr("leads out of the root folder 'room'")) << picture;
    }
}

TEST_F(Root, EveryCommandThatReadsModelsHasIt) {
    write_users("../out/leaf.inst");
    for (const std::string command :
         {"render -o o.png", "render --engine native -o o.png", "animate -o o.gif", "points -o o.png",
          "collage room/bark.png", "compile -o o.pov", "check", "stats", "print", "graph"}) {
        EXPECT_EQ(graftal(command + " --root room room/a.inst").status, 1) << command;
        const RunResult outside = graftal(command + " --root room out/leaf.inst");
        EXPECT_EQ(outside.status, 1) << command;
        EXPECT_THAT(outside.err, HasSubstr("'out/leaf.inst' leads out of the root folder 'room'")) << command;
    }
    EXPECT_EQ(files(), "entrance out room");
    EXPECT_THAT(graftal("check --root none room/a.inst").err, HasSubstr("--root: 'none' is not a folder"));
    EXPECT_EQ(shell("cd room; $graftal check -q --root . - <parts/leaf.inst").status, 0);
}

} // namespace
} // namespace graftal
