#include "runtime/povray/povray.h"

#include <csignal>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/image_files/image_files.h"
#include "runtime/system/interruption.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using testing::HasSubstr;

/// Writes and commits.
template<typename... Arguments> Status palette_saved(const std::string& path, const Arguments&... arguments) {
    PendingFile pending(path);
    const Status status = write_palette(pending, arguments...);
    return status.ok() ? pending.commit() : status;
}

/// A directory with a scene, and POV-Ray or a script that plays its part.
class Povray : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(directory_.create().ok());
        job_.directory = directory_.path();
        job_.width = 16;
        job_.height = 12;
    }
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    void scene(const std::string& text) const {
        std::ofstream(path("scene.pov"))
            << "#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location <0,0,-5> look_at 0 }\n"
            << text;
    }
    void fake(const std::string& script) {
        job_.program = path("fake_povray");
        std::ofstream(job_.program) << "#!/bin/sh\n" << script;
        std::filesystem::permissions(job_.program, std::filesystem::perms::owner_all);
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

    TemporaryDirectory directory_;
    PovrayJob job_;
};

TEST_F(Povray, RendersAScene) {
    scene("#debug \"@@50\\n\"\nsphere { 0, 1 pigment { rgb <1,0,0> } finish { emission 1 diffuse 0 } "
          "}\n#debug \"@@100\\n\"\n");
    std::vector<PovrayProgress> seen;
    job_.on_progress = [&](const PovrayProgress& p) { seen.push_back(p); };
    job_.finite_objects = 1;
    const PovrayResult result = run_povray(job_);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
    EXPECT_TRUE(result.log.finished);
    EXPECT_TRUE(result.log.trace_seconds.has_value());
    EXPECT_GT(result.process.peak_bytes, 1'000'000u);
    ASSERT_FALSE(seen.empty());
    EXPECT_EQ(seen.back(), (PovrayProgress{PovrayProgress::Stage::rendering, 1.0}));
    Image image;
    ASSERT_TRUE(read_image(path("picture.png"), image).ok());
    EXPECT_EQ(image.width, 16);
    EXPECT_EQ(image.height, 12);
    EXPECT_FALSE(exists("picture.pov-state"));
    EXPECT_FALSE(exists("settings.ini"));
}

TEST_F(Povray, LinearPictureHoldsTheColourAsItIs) {
    scene("box { <-9,-9,0>, <9,9,1> pigment { rgb <0.25,0.5,0.75> } finish { emission 1 ambient 0 diffuse 0 "
          "} }\n");
    job_.format = PovrayJob::Format::linear16;
    ASSERT_TRUE(run_povray(job_).status.ok());
    Image image;
    ASSERT_TRUE(read_image(path("picture.png"), image).ok());
    const float expected[] = {0.25f, 0.5f, 0.75f};
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        ASSERT_NEAR(image.pixels[i], expected[i % 3], 1.0 / 65535);
}

TEST_F(Povray, PaletteIsReadAsLinear) {
    ASSERT_TRUE(palette_saved(path("palette.png"), 2, 1, std::vector(2, Rgb(0.1, 0.2, 0.3))).ok());
    scene("box { <-9,-9,0>, <9,9,1> pigment { image_map { png \"palette.png\" gamma 1.0 } }"
          " finish { emission 1 ambient 0 diffuse 0 } }\n");
    job_.format = PovrayJob::Format::linear16;
    const PovrayResult result = run_povray(job_);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
    Image image;
    ASSERT_TRUE(read_image(path("picture.png"), image).ok());
    const float expected[] = {0.1f, 0.2f, 0.3f};
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        ASSERT_NEAR(image.pixels[i], expected[i % 3], 1.01 / 65535);
}

TEST_F(Povray, PictureDoesNotDependOnThreadsOrRuns) {
    scene("light_source { <5,5,-9>, 1 }\n"
          "#for (I, 0, 40) sphere { <mod(I,7)-3, mod(I,5)-2, mod(I,3)>, 0.4 pigment { rgb <1,I/40,0> } } "
          "#end\n");
    job_.width = 160;
    job_.height = 120;
    job_.antialias = 3;
    std::vector<Image> pictures;
    for (const int threads : {1, 2, 2, 3}) {
        job_.threads = threads;
        ASSERT_TRUE(run_povray(job_).status.ok());
        ASSERT_TRUE(read_image(path("picture.png"), pictures.emplace_back()).ok());
    }
    for (const Image& picture : pictures)
        EXPECT_EQ(compare_images(picture, pictures.front()).differing, 0u);
}

TEST_F(Povray, ParseErrorNamesTheBody) {
    scene("#declare M_trunk = sphere { 0, 1 }\n#declare M_leaf = mesh2 {\n\n  nonsense\n}\n");
    const PovrayResult result = run_povray(job_);
    EXPECT_THAT(result.status.message(), HasSubstr("scene.pov line 7: "));
    EXPECT_THAT(result.status.message(), HasSubstr("(in M_leaf)"));
    EXPECT_EQ(result.process.exit_code, 1);
    EXPECT_FALSE(exists("picture.png"));
}

TEST_F(Povray, EmptySceneIsNoSuccess) {
    scene("");
    EXPECT_EQ(run_povray(job_).status.message(), "POV-Ray found no objects in the scene");
    EXPECT_FALSE(exists("picture.png"));
}

TEST_F(Povray, ReplacedMatrixIsNoSuccess) {
    scene("sphere { 0, 1 matrix <1e-11,0,0, 0,1,0, 0,0,1, 0,0,0> }\n");
    EXPECT_THAT(run_povray(job_).status.message(), HasSubstr("too small"));
    EXPECT_FALSE(exists("picture.png"));
}

TEST_F(Povray, LostObjectIsNoSuccess) {
    scene("sphere { 0, 1 }\n");
    job_.finite_objects = 2;
    EXPECT_EQ(run_povray(job_).status.message(),
              "POV-Ray found 1 objects in a scene of 2: the picture is wrong");
    job_.may_be_empty = 1;
    EXPECT_TRUE(run_povray(job_).status.ok());
    job_.finite_objects = 3;
    EXPECT_FALSE(run_povray(job_).status.ok());
}

TEST_F(Povray, MissingPovraySaysHowToInstallIt) {
    scene("sphere { 0, 1 }\n");
    job_.program = "graftal-no-povray";
    EXPECT_EQ(run_povray(job_).status.message(),
              "cannot find the program 'graftal-no-povray'; install it with 'apt-get install povray'");
}

TEST_F(Povray, CrashIsReported) {
    fake("echo 'POV-Ray finished' >&2\n: > picture.png\nkill -SEGV $$\n");
    EXPECT_THAT(run_povray(job_).status.message(), HasSubstr("crashed: Segmentation fault"));
    EXPECT_FALSE(exists("picture.png"));
}

TEST_F(Povray, KillHintsAtMemory) {
    fake("kill -KILL $$\n");
    EXPECT_THAT(run_povray(job_).status.message(), HasSubstr("out of memory"));
}

TEST_F(Povray, StatusZeroWithoutAPictureIsNoSuccess) {
    fake("echo 'POV-Ray finished' >&2\nexit 0\n");
    EXPECT_EQ(run_povray(job_).status.message(), "POV-Ray finished without writing the picture");
}

TEST_F(Povray, OldPictureIsNotMistakenForTheNewOne) {
    std::ofstream(path("picture.png")) << "old";
    fake("echo 'POV-Ray finished' >&2\nexit 0\n");
    EXPECT_FALSE(run_povray(job_).status.ok());
    EXPECT_FALSE(exists("picture.png"));
}

TEST_F(Povray, PictureWithoutTheLastWordIsNoSuccess) {
    fake(": > picture.png\necho 'something odd' >&2\nexit 0\n");
    EXPECT_EQ(run_povray(job_).status.message(),
              "POV-Ray ended with status 0 but did not finish:\n    something odd");
    EXPECT_FALSE(exists("picture.png"));
}

TEST_F(Povray, FailureWithoutAMessageShowsTheLastLines) {
    fake("echo 'Cannot create render state output file.' >&2\nexit 1\n");
    EXPECT_EQ(run_povray(job_).status.message(),
              "POV-Ray failed with status 1:\n    Cannot create render state output file.");
}

TEST_F(Povray, InterruptionEndsAHangingChild) {
    fake("trap 'echo \"Render cancelled by user\" >&2; exit 2' TERM\n"
         "echo 'Rendered 1 of 192 pixels' >&2\nwhile :; do sleep 0.05; done\n");
    const Interruption interruption;
    job_.cancel = interruption.flag();
    job_.on_progress = [](const PovrayProgress&) { ::raise(SIGINT); };
    const PovrayResult result = run_povray(job_);
    EXPECT_TRUE(result.process.cancelled);
    EXPECT_EQ(result.status.message(), "interrupted");
}

TEST_F(Povray, ArgumentsSayWhatWasAsked) {
    job_.threads = 3;
    job_.antialias = 4;
    EXPECT_THAT(povray_arguments(job_), testing::IsSupersetOf({"+Iscene.pov", "+Opicture.png", "+W16", "+H12",
                                                               "-D", "+FN8", "+WT3", "+R4", "-J"}));
    job_.antialias = std::nullopt;
    job_.format = PovrayJob::Format::linear16;
    EXPECT_THAT(povray_arguments(job_), testing::IsSupersetOf({"-A", "+FN16", "File_Gamma=1.0"}));
}

TEST_F(Povray, ALineBelongsToABody) {
    scene("#declare M_a = mesh2 {\n  x\n}\ny\n#declare M_b_2 = sphere { }\nobject { M_a }\n");
    const std::string file = path("scene.pov"); // its first three lines are the same for all tests
    EXPECT_EQ(body_at(file, 3), "");
    EXPECT_EQ(body_at(file, 4), "M_a");
    EXPECT_EQ(body_at(file, 5), "M_a");
    EXPECT_EQ(body_at(file, 7), "");
    EXPECT_EQ(body_at(file, 8), "M_b_2");
    EXPECT_EQ(body_at(file, 9), "M_a");
    EXPECT_EQ(body_at(file, 800), "");
    EXPECT_EQ(body_at(path("none.pov"), 8), "");
}

} // namespace
} // namespace graftal
