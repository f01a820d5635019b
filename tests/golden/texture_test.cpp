// Materials with pictures, by both engines.

#include "tests/golden/command_line.h"

#include <gmock/gmock.h>

#include "runtime/image/image.h"

namespace graftal {
namespace {

using testing::HasSubstr;

const std::string textured = "'" + source_path("tests/golden/textured/textured.inst") + "' ";

class Textured : public CommandLine {};

/// POV-Ray draws facets, which leave the round parts a little.
TEST_F(Textured, BothEnginesShowTheSame) {
    for (const std::string engine : {"native", "povray"}) {
        const RunResult result = graftal("render " + textured + "--size 320x200 --plain-light -q --engine " +
                                         engine + " -o " + engine + ".png");
        ASSERT_EQ(result.status, 0) << result.err;
    }
    const ImageDifference difference = compare_images(picture("native.png"), picture("povray.png"), 0.1);
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

TEST_F(Textured, CompiledScenesHaveThePicturesBesideThem) {
    ASSERT_EQ(graftal("compile " + textured + "-o scene.pov").status, 0);
    EXPECT_EQ(files(), "scene.pov textured.inst_I_1.png textured.inst_I_2.png");
    EXPECT_EQ(graftal("compile " + textured + "-o -").status, 1);
}

} // namespace
} // namespace graftal
