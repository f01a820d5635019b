#include "tests/golden/command_line.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "runtime/image_files/image_files.h"

namespace graftal {
namespace {

using testing::HasSubstr;

class Render : public CommandLine {};

TEST_F(Render, MakesAPictureNamedAfterTheModelHere) {
    const RunResult result = graftal("render --engine povray " + gasket + small);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, testing::StartsWith("sierpinski.png: "));
    EXPECT_EQ(result.err.find('\r'), std::string::npos) << "no progress in a pipe";
    EXPECT_EQ(files(), "sierpinski.png");
    EXPECT_EQ(temporary_files(), "");
    EXPECT_EQ(picture("sierpinski.png").width, 96);
    EXPECT_EQ(picture("sierpinski.png").height, 54);
}

TEST_F(Render, TwoRunsGiveTheSameBytes) {
    for (const std::string name : {"a", "b"}) {
        ASSERT_EQ(shell("mkdir " + name + "; cd " + name + "; \"$graftal\" compile " + pound_sign + small +
                        "-o scene.pov -q")
                      .status,
                  0);
    }
    EXPECT_EQ(shell("diff -r a b").status, 0) << "scene or palettes differ";
    EXPECT_NE(shell("cat a/*.pov").out, "");
    ASSERT_EQ(graftal("render --engine povray " + pound_sign + small + "-o c.png --threads 1").status, 0);
    ASSERT_EQ(graftal("render --engine povray " + pound_sign + small + "-o d.png --threads 2").status, 0);
    EXPECT_EQ(compare_images(picture("c.png"), picture("d.png")).differing, 0u);
}

TEST_F(Render, QuietIsSilent) {
    const RunResult result = graftal("render --engine povray --quiet " + gasket + small);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out + result.err, "");
    EXPECT_EQ(files(), "sierpinski.png");
}

TEST_F(Render, PictureSaysWhichCommandMadeIt) {
    ASSERT_EQ(graftal("render --engine povray " + gasket + small + "-o 'a b.png'").status, 0);
    EXPECT_THAT(read("a b.png"), HasSubstr("graftal render sierpinski.inst --engine povray --size 96x54"))
        << "and nothing of this machine";
    EXPECT_THAT(read("a b.png"), HasSubstr("graftal 0."));
}

TEST_F(Render, LinearPngAndExrHoldTheSameValues) {
    ASSERT_EQ(
        graftal("render --engine povray " + gasket + small + "--antialias off --test-linear -o a.png").status,
        0);
    ASSERT_EQ(graftal("render --engine povray " + gasket + small + "--antialias off -o a.exr").status, 0);
    // An EXR of POV-Ray has half floats, of 11 bits.
    EXPECT_LE(compare_images(picture("a.png"), picture("a.exr")).max, 1.0 / 2048);
}

TEST_F(Render, SoftLightIsFollowedByBothEngines) {
    write("m.inst", "sky { zenith: 0.6, 0.6, 0.6  bounces: 2 }\nmaterial white { color: 1, 1, 1  diffuse: 1  "
                    "ambient: 0  specular: 0 }\nobject m { sphere material: white }\n");
    const RunResult povray = graftal("render --engine povray m.inst" + small + "-o a.png");
    EXPECT_EQ(povray.status, 0);
    EXPECT_THAT(povray.err, testing::HasSubstr("no light from surface to surface"));
    const RunResult native = graftal("render m.inst --engine native" + small + "-o b.png");
    EXPECT_EQ(native.status, 0);
    EXPECT_THAT(native.err, testing::HasSubstr("b.png: up to 64 samples per pixel"));
    // A white ball in an even sky cannot be seen, except for the dither; a list of 40 lights is near.
    const Image furnace = picture("b.png");
    const auto [least, most] = std::ranges::minmax(furnace.pixels);
    EXPECT_LE(most - least, 1.001f / 255);
    EXPECT_LT(compare_images(picture("a.png"), furnace).mean, 3.0 / 255);
}

/// However few lights POV-Ray has the time for, each lamp, sun and sky is among them.
TEST_F(Render, LightThatIsMoreThanAPointStaysInPovraysList) {
    const std::string scene =
        "ground { height: 0 }\nbackground: 0.2, 0.2, 0.2\nobject m { sphere translate: 0, 1, 0 }\n";
    for (const std::string light :
         {"light { location: -2, 6, 3  size: 3, 1  look_at: 0, 1, 0 }\n",
          "light { location: -2, 6, 3  radius: 1  look_at: 0, 1, 0 }\n",
          "light { sun: -1, 2, 1  angle: 5 }\n", "sky { zenith: 0.5, 0.6, 0.8  horizon: 0.8, 0.8, 0.8 }\n"}) {
        SCOPED_TRACE(light);
        write("m.inst", light + scene);
        EXPECT_LT(engines_differ("m.inst --size 96x54 --test-listed-lights", 0.1).mean, 1.0 / 255);
        ASSERT_EQ(graftal("render --engine povray m.inst --size 96x54 --work 0.01 -q -o few.png").status, 0);
        EXPECT_LT(compare_images(picture("few.png"), picture("native.png")).mean, 12.0 / 255);
    }
}

TEST_F(Render, OldPictureIsReplacedWhole) {
    write("a.png", "old");
    ASSERT_EQ(graftal("render --engine povray " + gasket + small + "-o a.png").status, 0);
    EXPECT_EQ(picture("a.png").width, 96);
    EXPECT_EQ(files(), "a.png");
}

TEST_F(Render, KeptSceneCanBeRenderedByHand) {
    ASSERT_EQ(
        graftal("render --engine povray " + pound_sign + small + "--antialias off -q --keep kept -o a.png")
            .status,
        0);
    ASSERT_EQ(shell("cd kept && povray +Iscene.pov +Ob.png +W96 +H54 -D -A +FN8 File_Gamma=srgb 2>/dev/null")
                  .status,
              0);
    EXPECT_EQ(compare_images(picture("a.png"), picture("kept/b.png")).differing, 0u);
}

TEST_F(Render, CameraOfTheCommandLineMovesThePicture) {
    ASSERT_EQ(graftal("render --engine povray " + gasket + small + "-q -o a.png").status, 0);
    ASSERT_EQ(graftal("render --engine povray " + gasket + small +
                      "-q -o b.png --camera 'location=0,0,9 look_at=0,0,0' --camera 'orthographic width=40'")
                  .status,
              0);
    EXPECT_GT(compare_images(picture("a.png"), picture("b.png")).differing, 100u);
}

TEST_F(Render, CompiledSceneNeedsNothingElse) {
    ASSERT_EQ(graftal("compile " + gasket + small + ">a.pov").status, 0);
    ASSERT_EQ(graftal("compile " + gasket + small + "-o b.pov").status, 0);
    EXPECT_EQ(read("a.pov"), read("b.pov"));
    EXPECT_EQ(shell("povray +Ia.pov +Oa.png +W96 +H54 -D 2>/dev/null").status, 0);
    ASSERT_EQ(graftal("compile " + gasket + small + "-o gasket.inc -q").status, 0);
    EXPECT_THAT(read("gasket.inc"), HasSubstr("#include \"gasket.inc\"")) << "says how to use itself";
    EXPECT_THAT(read("gasket.inc"), HasSubstr("#declare"));
}

/// The mean of each channel.
std::array<double, 3> mean_colour(const Image& image) {
    std::array<double, 3> sum{};
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % channels < 3) sum[i % channels] += static_cast<double>(image.pixels[i]);
    for (double& part : sum)
        part /= static_cast<double>(image.pixels.size() / channels);
    return sum;
}

/// An .inc in a folder of its own is used from another, by scenes that put their textures in place of its.
TEST_F(Render, IncludesTakeTexturesFromTheScenesThatUseThem) {
    std::filesystem::create_directory(path("parts"));
    write("two.inst", "material wood { color: 1, 0, 0 }  material leaf { color: 0, 0, 1 }\n"
                      "object two { instance: sphere  material: wood  instance: sphere  translate: 3, 0, 0  "
                      "material: leaf }\n");
    write("one.inst", "object one { instance: sphere  instance: cube  translate: 3, 0, 0 }\n");
    ASSERT_EQ(graftal("compile two.inst -o parts/two.inc -q").status, 0);
    ASSERT_EQ(graftal("compile one.inst -o parts/one.inc -q --name Other").status, 0);
    ASSERT_EQ(graftal("compile " + pound_sign + " --steps 5 -o parts/pound.inc -q").status, 0);
    ASSERT_TRUE(exists("parts/pound_P_1.png")) << "a palette that must be found";
    const std::string green = "texture { pigment { rgb y } finish { ambient 1 diffuse 0 } }";
    const auto draw = [&](const std::string& before, const std::string& file, const std::string& object) {
        write("by_hand.pov", "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n" + before +
                                 "\n#include \"" + file +
                                 "\"\nlight_source { <2, 3, -9> rgb 1 shadowless }\n" +
                                 "camera { orthographic location <1.5, 0, -9> look_at <1.5, 0, 0> "
                                 "right 6*x up 3*y }\n" +
                                 object + "\n");
        const RunResult result = shell("povray +Iby_hand.pov +Oby_hand.png +Lparts +W80 +H40 -D 2>&1");
        EXPECT_EQ(result.status, 0) << result.out;
        return mean_colour(picture("by_hand.png"));
    };
    const auto expect_green_only = [](const std::array<double, 3>& mean, const char* what) {
        EXPECT_LT(mean[0], 0.01) << what;
        EXPECT_GT(mean[1], 0.1) << what;
        EXPECT_LT(mean[2], 0.01) << what;
    };
    const auto plain = draw("", "two.inc", "object { Two }");
    EXPECT_GT(plain[0], 0.02);
    EXPECT_GT(plain[2], 0.02);
    const auto other_wood = draw("#declare Two_T_wood = " + green + "\n", "two.inc", "object { Two }");
    EXPECT_LT(other_wood[0], 0.01);
    EXPECT_GT(other_wood[1], 0.1);
    EXPECT_NEAR(other_wood[2], plain[2], 1e-6) << "the other material stays";
    expect_green_only(draw("#declare Two_bare = yes;", "two.inc", "object { Two " + green + " }"),
                      "all of several");
    expect_green_only(draw("", "one.inc", "object { Other " + green + " }"), "the only one");
    expect_green_only(
        draw("", "one.inc",
             "box { Other_min, Other_max " + green + " } sphere { Other_min + <1,1,1>, 0.9 " + green + " }"),
        "corners");
    const auto palette = draw("", "pound.inc", "object { Pound_sign }");
    EXPECT_GT(palette[0] + palette[1] + palette[2], 0.05);
}

TEST_F(Render, SceneWithPalettesHasNoPlaceOnStandardOutput) {
    const RunResult result = graftal("compile " + pound_sign + small);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("write the scene to a file with '-o SCENE.pov'"));
}

TEST_F(Render, CompareMeasuresAndJudges) {
    ASSERT_TRUE(write_image(path("a.png"), Image{2, 1, 1, {0, 1}}, SampleFormat::srgb8).ok());
    ASSERT_TRUE(write_image(path("b.png"), Image{2, 1, 1, {0.2f, 1}}, SampleFormat::srgb8).ok());
    ASSERT_TRUE(write_image(path("c.png"), Image{1, 2, 1, {0, 1}}, SampleFormat::srgb8).ok());
    const RunResult same = graftal("compare a.png a.png");
    EXPECT_EQ(same.status, 0);
    EXPECT_EQ(same.out, "max   0\nmean  0\nrms   0\np99   0\ncount 0 of 2\n");
    const RunResult apart = graftal("compare a.png b.png");
    EXPECT_EQ(apart.status, 1);
    EXPECT_EQ(apart.out,
              "max   0.200000003\nmean  0.100000001\nrms   0.141421358\np99   0.200000003\ncount 1 of 2\n");
    EXPECT_EQ(graftal("compare a.png b.png --threshold 0.21").status, 0);
    EXPECT_EQ(graftal("compare a.png b.png --threshold 0.19").status, 1);
    const RunResult sizes = graftal("compare a.png c.png --threshold 9");
    EXPECT_EQ(sizes.status, 1);
    EXPECT_EQ(sizes.err, "graftal: 'a.png' has 2x1 pixels, 'c.png' has 1x2\n");
    EXPECT_EQ(graftal("compare a.png none.png").status, 3);
}

/// Starts a slow rendering, sends it the signal once POV-Ray runs, and returns the exit status.
class InterruptedRender : public Render {
  protected:
    void SetUp() override {
        Render::SetUp();
        std::filesystem::create_directory(path("bin"));
        // Says where it is, then does nothing until it is told to end.
        write("bin/povray", "#!/bin/sh\ntrap 'echo cleaned >&2; exit 2' TERM\necho $$ >'" + path("child") +
                                ".new'\nmv '" + path("child") + ".new' '" + path("child") +
                                "'\nwhile :; do sleep 0.02; done\n");
        ASSERT_EQ(shell("chmod +x bin/povray").status, 0);
    }

    int render_until(int signal) {
        const pid_t pid = ::fork();
        if (pid == 0) {
            const int null_device = ::open("/dev/null", O_RDWR);
            ::dup2(null_device, STDERR_FILENO);
            ::signal(SIGINT, SIG_DFL);
            ::setenv("PATH", (path("bin") + ":/usr/bin:/bin").c_str(), 1);
            ::setenv("TMPDIR", (directory_.path() + "/tmp").c_str(), 1);
            const std::string model = source_path("scenes/hart/sierpinski.inst"), picture = path("a.png");
            ::execl(GRAFTAL_PROGRAM, "graftal", "render", model.c_str(), "-o", picture.c_str(), "--size",
                    "96x54", "--engine", "povray", "--unconfined", nullptr);
            ::_exit(126);
        }
        for (int i = 0; i < 2000 && !exists("child"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        EXPECT_NE(temporary_files(), "");
        ::kill(pid, signal);
        int wait_status = 0;
        ::waitpid(pid, &wait_status, 0);
        return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : -WTERMSIG(wait_status);
    }
    bool child_lives() const { return ::kill(std::stoi(read("child")), 0) == 0; }
};

TEST_F(InterruptedRender, LeavesNoFileNoFolderAndNoChild) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        EXPECT_EQ(render_until(signal), 128 + signal);
        EXPECT_EQ(temporary_files(), "");
        EXPECT_FALSE(exists("a.png"));
        EXPECT_FALSE(child_lives());
        std::filesystem::remove(path("child"));
    }
    EXPECT_EQ(files(), "bin");
}

TEST_F(InterruptedRender, KeepsTheOldPicture) {
    write("a.png", "old");
    EXPECT_EQ(render_until(SIGINT), 128 + SIGINT);
    EXPECT_EQ(read("a.png"), "old");
}

TEST_F(InterruptedRender, ChildDiesEvenIfWeAreKilled) {
    EXPECT_EQ(render_until(SIGKILL), -SIGKILL);
    for (int i = 0; i < 400 && child_lives(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_FALSE(child_lives());
    EXPECT_FALSE(exists("a.png"));
}

} // namespace
} // namespace graftal
