// Materials with pictures, by both engines.

#include "tests/golden/command_line.h"

#include <gmock/gmock.h>

#include "runtime/image_files/image_files.h"

namespace graftal {
namespace {

using testing::HasSubstr;

const std::string textured = "'" + source_path("tests/golden/textured/textured.inst") + "' ";

class Textured : public CommandLine {};

/// POV-Ray draws facets, which leave the round parts a little.
TEST_F(Textured, BothEnginesShowTheSame) {
    const ImageDifference difference = engines_differ(textured + "--size 320x200 --plain-light", 0.1);
    EXPECT_LT(difference.mean, 1e-3);
    EXPECT_LT(difference.over_threshold, 150u);
}

TEST_F(Textured, WhatIsClearIsNotThereNorThrowsShadows) {
    write("a.inst", "material leaf { texture: \"leaf.png\" }\n"
                    "camera { location: 0,0,5 look_at: 0,0,0 orthographic width: 4 }\n"
                    "light { sun: 0,0,1 color: 1,1,1 }\nbackground: 0, 0, 1\n"
                    "object o { instance: cube scale: 1,1,0.01 material: leaf\n"
                    "  instance: cube scale: 1,1,0.01 translate: 0,0,-1 }\n");
    ASSERT_EQ(shell("cp '" + source_path("tests/golden/textured/leaf.png") + "' .").status, 0);
    for (const std::string engine : {"native", "povray"}) {
        SCOPED_TRACE(engine);
        ASSERT_EQ(graftal("render a.inst --antialias off --size 64x64 -q -o a.png --engine " + engine).status,
                  0);
        const Image image = picture("a.png");
        std::size_t grey = 0, leaf = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += static_cast<std::size_t>(image.channels)) {
            const float red = image.pixels[i], blue = image.pixels[i + 2];
            grey += red > 0.8f && blue > 0.8f; // of the cube behind, not shadowed
            leaf += red != blue && blue < 0.6f;
        }
        // Half of 64 x 64 pixels wide; the picture covers three tenths.
        EXPECT_NEAR(static_cast<double>(leaf) / 1024, 0.31, 0.02);
        EXPECT_NEAR(static_cast<double>(grey + leaf) / 1024, 1, 0.02);
    }
}

TEST_F(Textured, AMaterialHasItsPicturesMeanColour) {
    const RunResult printed = graftal("print " + textured);
    ASSERT_EQ(printed.status, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("leaf.png\"\n  around: 1\n"));
    write("again.inst", printed.out);
    EXPECT_EQ(graftal("print again.inst").out, printed.out);
}

TEST_F(Textured, WhatIsNoPictureIsAnErrorOfTheModel) {
    write("bad.png", "no picture");
    write("a.inst", "material bark { texture: \"bad.png\" }\nobject o { sphere material: bark }\n");
    for (const std::string command : {"render a.inst", "render --engine native a.inst", "check a.inst"}) {
        const RunResult result = graftal(command);
        EXPECT_EQ(result.status, 1) << command;
        EXPECT_THAT(result.err, HasSubstr("a.inst:1:26: error: cannot read picture 'bad.png'")) << command;
    }
    EXPECT_EQ(files(), "a.inst bad.png");
}

/// Twice as wide as high, brighter to the right.
Image sky_picture(int width = 64) {
    Image image{width, width / 2, 3, {}};
    for (int y = 0; y < width / 2; ++y)
        for (int x = 0; x < width; ++x)
            for (const int c : {1, 2, 3})
                image.pixels.push_back(0.1f * static_cast<float>(c) + static_cast<float>(x) / 64);
    return image;
}

class WithEnvironment : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        ASSERT_TRUE(write_image(path("sky.exr"), sky_picture(), SampleFormat::srgb8).ok());
        write("a.inst", "sky { environment: \"sky.exr\"  turn: 40  brightness: 0.7 }\n"
                        "ground { height: -1 }\nobject a { sphere }\n");
    }

    /// On a.inst; `listed_255`: how far apart pictures by one list of lights may be.
    void expect_engines_agree(double listed_255) {
        for (const std::string engine :
             {"povray", "native --test-listed-lights", "native --samples 256 --noise 0"}) {
            const RunResult result =
                graftal("render a.inst --size 120x90 -q -o '" + engine + ".png' --engine " + engine);
            ASSERT_EQ(result.status, 0) << result.err;
        }
        const Image povray = picture("povray.png");
        EXPECT_LT(compare_images(povray, picture("native --test-listed-lights.png")).mean, listed_255 / 255);
        EXPECT_LT(compare_images(povray, picture("native --samples 256 --noise 0.png")).mean, 2.0 / 255);
    }
};

TEST_F(WithEnvironment, BothEnginesShowTheSame) {
    expect_engines_agree(0.1);
}

TEST_F(WithEnvironment, ReadsAgainAsItIsPrinted) {
    const RunResult printed = graftal("print a.inst");
    ASSERT_EQ(printed.status, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("  environment: \"sky.exr\"\n  turn: 40\n  brightness: 0.7\n"));
    write("again.inst", printed.out);
    EXPECT_EQ(graftal("print again.inst").out, printed.out);
}

TEST_F(WithEnvironment, CloudsAreTheSameInBothEnginesAndPrint) {
    write("a.inst", "light { sun: 1, 1, 0.5  angle: 1 }\nsky { clear: 3  clouds: 0.5  turn: 20 }\n"
                    "haze { distance: 50  height: 3 }\nground { height: -1 }\nobject a { sphere }\n"
                    "camera { location: 0, 0, 5  look_at: 0, 1, 0  angle: 90 }\n");
    expect_engines_agree(0.2);
    const RunResult printed = graftal("print a.inst");
    EXPECT_THAT(printed.out, HasSubstr("  clouds: 0.5\n  turn: 20\n"));
    write("again.inst", printed.out);
    EXPECT_EQ(graftal("print again.inst").out, printed.out);
}

TEST_F(WithEnvironment, AClearSkyWithoutBrightnessIsBlack) {
    write("a.inst", "light { sun: 1, 1, 1 }\nsky { clear: 3  brightness: 0 }\nobject a { sphere }\n");
    expect_engines_agree(0.2);
}

TEST_F(WithEnvironment, ACompiledSceneHasItBesideIt) {
    ASSERT_EQ(graftal("compile a.inst -o scene.pov").status, 0);
    EXPECT_EQ(files(), "a.inst scene.pov scene_sky.exr sky.exr");
    write("behind.inst", "sky { environment: \"sky.exr\" }\nbackground: 0,0,0\nobject a { sphere }\n");
    ASSERT_EQ(graftal("compile behind.inst -o behind.pov").status, 0);
    EXPECT_THAT(files(), testing::Not(HasSubstr("behind_sky.exr")));
}

TEST_F(WithEnvironment, WhatItsPictureIsNotIsSaidAtItsPlace) {
    const auto said = [&](const std::string& name) {
        write("b.inst", "sky {\n  environment: \"" + name + "\"\n}\nobject a { sphere }\n");
        return graftal("check b.inst").err;
    };
    ASSERT_TRUE(write_image(path("square.exr"), {1, 1, 3, {1, 1, 1}}, SampleFormat::srgb8).ok());
    EXPECT_THAT(said("square.exr"),
                HasSubstr("b.inst:2:16: warning: this picture of 1 x 1 pixels is stretched"));
    ASSERT_TRUE(write_image(path("dark.exr"), {2, 1, 3, {1, 1, 1, -1, 0, 0}}, SampleFormat::srgb8).ok());
    EXPECT_THAT(said("dark.exr"), HasSubstr("b.inst:2:16: warning: 1 of this picture's pixels are no light"));
    ASSERT_TRUE(write_image(path("wide.png"), {8194, 4097, 1, std::vector<float>(8194u * 4097, 1.0f)},
                            SampleFormat::srgb8)
                    .ok());
    EXPECT_THAT(said("wide.png"),
                HasSubstr("warning: this picture of 8194 x 4097 pixels is used at 2732 x 1366"));
    write("b.inst", "sky { environment: \"sky.exr\"  turn: 1e30 }\nobject a { sphere }\n");
    EXPECT_THAT(graftal("check b.inst").err,
                HasSubstr("error: 'turn' must lie within 36000 degrees, not 1e"));
    write("none.exr", "no picture");
    EXPECT_THAT(said("none.exr"), HasSubstr("b.inst:2:16: error: cannot read picture 'none.exr'"));
}

/// A model that is used brings no light, so nobody reads its pictures.
TEST_F(WithEnvironment, IsThatOfTheModelItselfAlone) {
    write("none.exr", "no picture");
    write("part.inst", "sky { environment: \"none.exr\" }\nobject a { sphere }\n");
    write("b.inst", "use part = \"part.inst\"\nobject b { part }\n");
    EXPECT_EQ(graftal("check -q b.inst").status, 0);
    EXPECT_EQ(graftal("check -q part.inst").status, 1);
}

TEST_F(Textured, CompiledScenesHaveThePicturesBesideThem) {
    ASSERT_EQ(graftal("compile " + textured + "-o scene.pov").status, 0);
    EXPECT_EQ(files(), "scene.pov scene_I_1.png scene_I_2.png");
    EXPECT_EQ(graftal("compile " + textured + "-o -").status, 1);
}

} // namespace
} // namespace graftal
