// The native engine by the command line: `render` and `animate` without POV-Ray, and the page about it.

#include "tests/golden/command_line.h"

#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "runtime/image/image.h"

namespace graftal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

const std::string elm = "'" + source_path("scenes/hart/elm.inst") + "' --steps 4 ";

class Native : public CommandLine {
  protected:
    RunResult render(const std::string& arguments) const {
        // Nothing that it could start is there.
        return shell("PATH=/nowhere \"$graftal\" render --engine native " + arguments);
    }
    std::uint64_t differing(const std::string& a, const std::string& b) const {
        return compare_images(picture(a), picture(b)).differing;
    }
    void expect_size(const std::string& name, int width, int height) const {
        const Image image = picture(name);
        EXPECT_EQ(image.width, width) << name;
        EXPECT_EQ(image.height, height) << name;
    }
};

TEST_F(Native, MakesAPictureNamedAfterTheModelHere) {
    const RunResult result = render(gasket + small);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err,
                MatchesRegex("sierpinski.png: 4 samples per pixel, error 0.5 px in [0-9]+\\.[0-9][0-9] s, "
                             "[0-9.]+ million rays per second\n"));
    EXPECT_EQ(files(), "sierpinski.png");
    EXPECT_EQ(temporary_files(), "");
    expect_size("sierpinski.png", 96, 54);
    EXPECT_THAT(read("sierpinski.png"), HasSubstr("graftal render sierpinski.inst --size 96x54"))
        << "says which command made it";
}

TEST_F(Native, SaysHowManySamplesThereAre) {
    const struct {
        const char *options, *samples;
    } cases[] = {{"--antialias off", ": 1 sample per pixel, error 0.5 px in "},
                 {"--antialias 1", ": 1 sample per pixel, error 0.5 px in "},
                 {"--antialias 3", ": 16 samples per pixel, error 0.5 px in "},
                 {"--antialias 3 --antialias off", ": 1 sample per pixel, error 0.5 px in "},
                 {"--antialias 3 --progressive", ": 16 samples per pixel, error 0.5 px in "},
                 {"--antialias 3 --no-progressive", ": 16 samples per pixel, error 0.5 px in "}};
    for (const auto& [options, samples] : cases) {
        const RunResult result = render(gasket + small + options);
        EXPECT_EQ(result.status, 0) << options << result.err;
        EXPECT_THAT(result.err, HasSubstr(samples)) << options;
    }
    const RunResult quiet = render(gasket + small + "--quiet --progressive");
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
    EXPECT_THAT(render(gasket + small + "--time").err,
                AllOf(HasSubstr(" s  frame\n"), HasSubstr(" s  prepare\n"), HasSubstr(" s  trace\n")));
}

TEST_F(Native, SaysThatTheCameraLooksPastTheModel) {
    const std::string warning = "warning: the camera sees no part of this model";
    const std::string away = "camera { location: 0, 0, 5  look_at: 0, 0, 10 }\n",
                      ball = "object a { sphere }\n";
    const struct {
        std::string text, options;
        bool warns;
    } cases[] = {
        {away + ball, "", true},
        {away + ball, " --camera 'look_at=0,0,0'", false},
        {ball, " --camera 'location=0,0,5 look_at=9,0,5'", true},
        {"camera { location: 0, 0, 5  look_at: 0, 0, 10  orthographic  width: 4 }\n" + ball, "", true},
        {away + "ground { }\n" + ball, "", false},
        {away + "sky { zenith: 0.3, 0.5, 0.9 }\n" + ball, "", false},
        {away + "object a {\n sphere\n plane translate: 0, -1, 0\n}\n", "", false}};
    for (const auto& [text, options, warns] : cases) {
        write("m.inst", text);
        const RunResult result = render("-q m.inst -o m.png" + options + small);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err.find(warning) != std::string::npos, warns) << text << options << result.err;
        EXPECT_EQ(result.err.find(warning), result.err.rfind(warning)) << "once";
        if (warns) {
            EXPECT_THAT(result.err, HasSubstr("'look_at: 0, 0, 0'"));
        }
    }
    // Terminals reach beyond the limit.
    write("m.rifs", "camera { location: 0, 3, 5  look_at: 0, 3, 0  orthographic  width: 2 }\n"
                    "rifs a {\n  map l { scale 1/2 }\n  terminal cube scale 5\n}\n");
    EXPECT_EQ(render("-q m.rifs --steps 0 -o m.png" + small).err.find(warning), std::string::npos);
    EXPECT_NE(render("-q m.rifs --steps 8 -o m.png" + small).err.find(warning), std::string::npos);
}

TEST_F(Native, LinearPngAndExrHoldTheSameValues) {
    ASSERT_EQ(render(gasket + small + "--test-linear -o a.png").status, 0);
    ASSERT_EQ(render(gasket + small + "-o a.exr").status, 0);
    expect_size("a.exr", 96, 54);
    EXPECT_LE(compare_images(picture("a.png"), picture("a.exr")).max, 1.0 / 65535 + 1e-3)
        << "16 bits of integer, and of floating point";
    ASSERT_EQ(render(gasket + small + "-o b.png").status, 0);
    EXPECT_GT(differing("a.png", "b.png"), 100u) << "not linear";
}

/// A picture without a background, put over a plain one, is the picture with that background.
TEST_F(Native, TransparentPicturesAreThoseBeforeAnyBackground) {
    const auto model = [](const std::string& background) {
        return "light { sun: 1, 2, 3 }\ncamera { location: 0, 0.5, 6 }\n" + background +
               "canonical object twig { union: cylinder\n scale: 0.05, 1, 0.05 }\n"
               "object a { union: sphere\n scale: 0.7\n tint: 0.9, 0.3, 0.2, 1\n union: twig\n"
               " translate: 0.9, -0.5, 0 }\n";
    };
    write("before.inst", model("background: 0.2, 0.4, 0.6\n"));
    const std::string options = " --engine native --size 64x48 --samples 16 --noise 0";
    for (const char* name : {"whole.exr", "clear.exr --transparent", "clear.png --transparent --bits 16"}) {
        const RunResult drawn = graftal("render before.inst" + options + " -o " + name);
        ASSERT_EQ(drawn.status, 0) << drawn.err;
    }
    const Image whole = picture("whole.exr"), clear = picture("clear.exr"), straight = picture("clear.png");
    ASSERT_EQ(clear.channels, 4);
    ASSERT_EQ(straight.channels, 4);
    const double behind[] = {0.2, 0.4, 0.6};
    int edges = 0, empty = 0;
    for (std::size_t i = 0; i < whole.pixels.size() / 3; ++i) {
        const double alpha = clear.pixels[4 * i + 3];
        edges += alpha > 0 && alpha < 1;
        empty += alpha == 0;
        EXPECT_NEAR(straight.pixels[4 * i + 3], alpha, 1e-4);
        for (std::size_t k = 0; k < 3; ++k) {
            const double light = clear.pixels[4 * i + k];
            EXPECT_NEAR(light + (1 - alpha) * behind[k], whole.pixels[3 * i + k], 2e-5);
            const float shown = srgb_encoded(static_cast<float>(alpha > 0 ? light / alpha : 0));
            EXPECT_NEAR(straight.pixels[4 * i + k], shown, 1e-3);
        }
    }
    EXPECT_GT(edges, 50);
    EXPECT_GT(empty, 500);
    EXPECT_EQ(graftal("render before.inst --engine povray --transparent -o a.png").status, 2);
}

TEST_F(Native, ReadsTheModelFromStandardInput) {
    ASSERT_EQ(render(gasket + small + "-o a.png").status, 0);
    ASSERT_EQ(render("- -o b.png" + small + " <" + gasket).status, 0);
    EXPECT_EQ(differing("a.png", "b.png"), 0u);
}

TEST_F(Native, TwoRunsGiveTheSameBytes) {
    for (const std::string name : {"a", "b"})
        ASSERT_EQ(shell("mkdir " + name + "; cd " + name +
                        "; \"$graftal\" render --engine native -q -o a.png " + elm + small)
                      .status,
                  0);
    EXPECT_EQ(read("a/a.png"), read("b/a.png"));
    for (const std::string threads : {"1", "2", "7"}) {
        ASSERT_EQ(render(elm + small + "-o c.png --threads " + threads).status, 0);
        EXPECT_EQ(differing("a/a.png", "c.png"), 0u) << threads;
    }
}

TEST_F(Native, AgreesWithPovray) {
    for (const std::string& model : {gasket, pound_sign, elm}) {
        ASSERT_EQ(render(model + small + "-q --error 0.1 -o native.png --steps 3").status, 0);
        ASSERT_EQ(graftal("render " + model + small + "-q --error 0.1 -o povray.png --steps 3").status, 0);
        const RunResult compared = graftal("compare native.png povray.png --threshold 0.03");
        EXPECT_EQ(compared.status, 0) << model << compared.out;
    }
}

TEST_F(Native, DoesAnyhowWhatPovrayMustBeTold) {
    ASSERT_EQ(render(pound_sign + small + "-q -o a.png").status, 0);
    for (const std::string option : {"--memory 1M", "--flatten"}) {
        const RunResult result = render(pound_sign + small + "-q -o b.png " + option);
        EXPECT_EQ(result.status, 0) << option;
        EXPECT_EQ(result.err, "") << option;
        EXPECT_EQ(differing("a.png", "b.png"), 0u) << option;
    }
}

TEST_F(Native, NeedsNoTemporaryFolder) {
    EXPECT_EQ(shell("TMPDIR=/nowhere \"$graftal\" render --engine native " + gasket + small).status, 0);
}

TEST_F(Native, FaultyModelIsStatusOneAndTouchesNoFile) {
    write("bad.inst", "object top {\n    union: nowhere\n}\n");
    write("dust.inst", "canonical object dust {\n    instance: dust scale: 1.2\n    terminal: sphere\n}\n"
                       "object all {\n    union: dust\n}\n");
    write("a.png", "old");
    const std::string before = files();
    const struct {
        std::string arguments, message;
    } cases[] = {
        {"bad.inst", "bad.inst:2:12: error: "},
        {"- <bad.inst", ":2:12: error: "},
        {"dust.inst", "does not contract"},
        {gasket + "--error 0", "error: the recursion has no end, and no option limits its depth"},
        {gasket + "--error-world 0",
         "hint: set a depth with '--steps N', or a smallest size in pixels with --error"},
        {gasket + "--at down", "error: the address does not exist"},
        {gasket + "--set k=1", "error: "},
    };
    for (const std::string progressive : {"", "--no-progressive "})
        for (const auto& [arguments, message] : cases) {
            const RunResult result = render("-o a.png " + progressive + arguments);
            EXPECT_EQ(result.status, 1) << arguments;
            EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
            EXPECT_EQ(result.out, "") << arguments;
        }
    EXPECT_EQ(files(), before);
    EXPECT_EQ(read("a.png"), "old");
}

TEST_F(Native, NothingIsLeftOutWithoutAnErrorToADepth) {
    EXPECT_EQ(render(gasket + small + "-q --error 0 --steps 5").status, 0);
    expect_size("sierpinski.png", 96, 54);
}

TEST_F(Native, EnvironmentIsStatusThree) {
    std::filesystem::create_directory(path("closed"));
    for (const std::string& arguments :
         std::vector<std::string>{"none.inst", gasket + "-o no/such/folder.png",
                                  gasket + "-o no/such/folder.exr", gasket + "-o /proc/a.png"}) {
        const RunResult result = render(small + arguments);
        EXPECT_EQ(result.status, 3) << arguments;
        EXPECT_THAT(result.err, AllOf(StartsWith("graftal: cannot "), testing::Not(HasSubstr("samples"))))
            << arguments;
    }
    EXPECT_EQ(files(), "closed");
}

/// Files of more than some KiB cannot be written.
TEST_F(Native, NoSpaceIsStatusThreeAndLeavesTheOldPicture) {
    const auto with_room = [&](int kib, const std::string& arguments) {
        return shell(
            fmt::format("trap '' XFSZ; ulimit -f {}; \"$graftal\" render --engine native -o a.png {}",
                        2 * kib, arguments));
    };
    write("a.png", "old");
    const RunResult none = with_room(1, elm + "--plain-light --size 320x180");
    EXPECT_EQ(none.status, 3);
    EXPECT_EQ(none.err, "graftal: cannot write picture 'a.png': File too large\n");
    EXPECT_EQ(read("a.png"), "old");
    EXPECT_EQ(files(), "a.png");

    // The first of the pictures is small, the last is not.
    const RunResult some = with_room(30, elm + "--plain-light --size 320x180 --antialias 4");
    EXPECT_EQ(some.status, 3);
    EXPECT_THAT(some.err, StartsWith("graftal: cannot write picture 'a.png': File too large\n"
                                     "a.png: unfinished: 1 sample per "));
    EXPECT_EQ(files(), "a.png");
    expect_size("a.png", 320, 180);
}

class NativeAnimation : public Native {
  protected:
    std::string frame(const std::string& folder, int number) const {
        return fmt::format("{}/frame_{:04}.png", folder, number);
    }
};

TEST_F(NativeAnimation, FramesAgreeWithPovrays) {
    const std::string turning =
        pound_sign + "--steps 2 --size 48x36 --antialias off --plain-light --frames 3 --turn 60 ";
    const RunResult result =
        shell("PATH=/nowhere \"$graftal\" animate --engine native -o native/ " + turning);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(
        result.err,
        MatchesRegex("native/: 3 frames, 25 per second; [0-9.]+ million rays per second; [0-9]+ s\n"));
    ASSERT_EQ(graftal("animate -q -o povray/ " + turning).status, 0);
    for (int i = 1; i <= 3; ++i) {
        const RunResult compared =
            graftal("compare --threshold 0.03 " + frame("native", i) + " " + frame("povray", i));
        EXPECT_EQ(compared.status, 0) << i << "\n" << compared.out;
    }
    EXPECT_GT(differing(frame("native", 1), frame("native", 2)), 50u);
}

TEST_F(NativeAnimation, FramesOfOneEngineAreNotTheOthers) {
    const std::string turning =
        pound_sign + "--steps 1 --size 48x36 --antialias off --plain-light --frames 2 -o a ";
    const auto found = [&](const std::string& options) {
        const RunResult result = graftal("animate " + turning + options);
        EXPECT_EQ(result.status, 0) << result.err;
        const std::size_t at = result.err.find(" were there before");
        return at == std::string::npos ? 0 : result.err[at - 1] - '0';
    };
    EXPECT_EQ(found("--engine native"), 0);
    EXPECT_EQ(found("--engine native --threads 1"), 2);
    EXPECT_EQ(found(""), 2) << "the default";
    EXPECT_EQ(found("--engine auto"), 2);
    EXPECT_EQ(found("--engine povray"), 0);
    EXPECT_EQ(found("--engine native"), 0);
}

TEST_F(NativeAnimation, FormsOtherThanFramesAreAssembled) {
    const std::string growing = "'" + source_path("scenes/abop/fig1_24f.lsys") +
                                "' --steps 1..3 --frames 3 --size 48x36 --engine native -q ";
    for (const std::string name : {"a.gif", "a.png"}) {
        ASSERT_EQ(graftal("animate " + growing + "-o " + name).status, 0);
        expect_size(name, 48, 36);
    }
    EXPECT_EQ(files(), "a.gif a.png");
    EXPECT_EQ(temporary_files(), "");
}

/// Of a plane that a flat map places both engines draw what is left of it: all, or a line, which is nothing.
/// It was to become a mesh.
TEST_F(Native, PlanesBehindFlatMapsAreWherePovrayHasThem) {
    const std::string ball = "object ball { sphere translate: 0, 1, 0 }\n";
    const std::string with_ball = "object all { union: floor, ball }\n";
    const std::string house =
        "canonical object ground { plane }\ncanonical object house { union: ground, ball }\n";
    struct {
        std::string text;
        bool stays;
    } const models[] = {
        {"object floor { plane scale: 1, 1e-11, 1 }\n" + with_ball, true},
        {"object floor { plane projection: 1, 0, 0, 0,  0, 0, 0, 0,  0, 0, 1, 0 }\n" + with_ball, true},
        {"object floor { plane projection: 1, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0 }\n" + with_ball, false},
        {"object floor { plane projection: 1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 0, 0 }\n" + with_ball, false},
        {house + "object all { house scale: 1, 1e-11, 1 }\n", true},
        {house + "object all { house projection: 1, 0, 0, 0,  0, 0, 0, 0,  0, 0, 1, 0 }\n", true},
        {house + "object all { house projection: 1, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0 }\n", false},
        {house + "canonical object street { union: house }\n"
                 "object all { instance: street translate: 0, 1, 0 projection: 1, 0, 0, 0,  0, 0, 0, 0,  0, "
                 "0, 1, 0\n"
                 "    rotate: y, 30 translate: 0, -1, 0 }\n",
         true},
        {"canonical object ground { plane }\n"
         "canonical object part { instance: ball\n"
         "    terminal: ground projection: 1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 0, 0\n"
         "    below: 2000 }\n"
         "object all { union: part, ball }\n",
         false},
    };
    const std::string view =
        "--camera 'location=0,2,-6 look_at=0,1,0' --antialias off --size 64x36 --plain-light ";
    for (const auto& [text, stays] : models) {
        write("model.inst", ball + text);
        const RunResult native = graftal("render --engine native " + view + "model.inst -o native.png");
        const RunResult povray = graftal("render " + view + "model.inst -o povray.png");
        ASSERT_EQ(native.status, 0) << text << native.err;
        ASSERT_EQ(povray.status, 0) << text << povray.err;
        EXPECT_LE(differing("native.png", "povray.png"), 20u) << text;
        const Image image = picture("native.png");
        const float* below = &image.pixels[image.channels * (64 * 34 + 2)];
        EXPECT_EQ(below[2] < below[0] + 0.05, stays) << "grey, and not of the sky: " << text;
    }
}

TEST_F(NativeAnimation, FaultOfOneFrameNamesIt) {
    const RunResult result = graftal("animate " + gasket + "--error 0 --engine native --frames 2 -o a/");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, AllOf(StartsWith("graftal: at frame 1 of 2:\n"),
                                  HasSubstr("error: the recursion has no end")));
    EXPECT_EQ(files(), "");
}

/// Every command of docs/native.md works; a small picture of each is enough.
TEST_F(Native, CommandsOfThePageWork) {
    const std::vector<std::string> commands = commands_of("docs/native.md");
    for (std::string words : commands) {
        words.resize(std::min(words.find(" #"), words.size()));
        if (words.starts_with("animate")) words += " --frames 2";
        if (words.find("--tile") != std::string::npos) words += " --tile 20,9,16x9";
        const bool draws = !words.starts_with("compare");
        const RunResult result =
            graftal(words + (draws ? " -q --size 48x27 --antialias off --error 2 --plain-light" : ""));
        EXPECT_EQ(result.status, 0) << words << "\n" << result.err;
    }
    EXPECT_GE(commands.size(), 6u);
}

} // namespace
} // namespace graftal
