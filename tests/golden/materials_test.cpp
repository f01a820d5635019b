// Metal, clear coats and glass on what becomes meshes, with tints and pictures, by both engines.

#include "tests/golden/command_line.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "runtime/image/image.h"

namespace graftal {
namespace {

using testing::HasSubstr;

class Materials : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        write("m.inst", R"(
            material amber { color: 0.9, 0.6, 0.2  transparency: 0.6  diffuse: 0.5  ior: 1.4 }
            material foil { color: 0.9, 0.6, 0.2  metallic: 1  reflection: 0.5  specular: 0.6 }
            material lacquer { color: 0.5, 0.6, 0.7  ior: 1.5 }
            material pane { texture: "leaf.png"  transparency: 0.4 }
            material tin { texture: "leaf.png"  metallic: 1  reflection: 0.3 }
            material enamel { texture: "bands.png"  ior: 1.5  reflection: 0.5  transparency: 0.3 }
            canonical object bush {
                cube  scale: 0.5
                bush  scale: 0.45  translate: 0.8, 0.6, 0  tint: 0.2, 0.8, 0.9, 0.4
                bush  scale: 0.45  translate: -0.8, 0.6, 0  tint: 0.9, 0.2, 0.1, 0.3
                bush  scale: 0.45  rotate: y, 40  translate: 0, -0.9, 0.3
            }
            object top {
                bush  translate: -2.5, 1.4, 0  material: amber    tint: 0.5, 0.5, 1, 0.3
                bush  translate: 0, 1.4, 0     material: foil     tint: 0.5, 0.5, 1, 0.3
                bush  translate: 2.5, 1.4, 0   material: lacquer  tint: 0.5, 0.5, 1, 0.3
                cube  scale: 0.7, 0.7, 0.01  rotate: y, 20   translate: -1.2, 0.8, 2  material: pane
                      tint: 0.3, 0.3, 1, 0.3
                cube  scale: 0.7, 0.7, 0.01  rotate: y, -20  translate: 1.2, 0.8, 2   material: tin
                cube  scale: 0.4  rotate: y, 25  translate: 0, 0.41, 2.5  material: enamel
                      tint: 0.3, 0.9, 0.3, 0.4
            }
            ground { height: 0  color: 0.5, 0.5, 0.45 }
            light { sun: -1, 2, 1.5  color: 0.8, 0.8, 0.7 }
            background { zenith: 0.3, 0.5, 0.9  horizon: 0.9, 0.9, 0.95 }
            camera { location: 0, 3, 9  look_at: 0, 1.2, 0  angle: 45 }
            steps: 3
        )");
        for (const std::string file : {"leaf.png", "bands.png"})
            ASSERT_EQ(shell("cp '" + source_path("tests/golden/textured/" + file) + "' .").status, 0);
    }
};

TEST_F(Materials, BothEnginesShowTheSame) {
    const ImageDifference difference = engines_differ("m.inst --antialias off --size 200x120", 0.05);
    EXPECT_LT(difference.mean, 2e-4);
    EXPECT_LT(difference.over_threshold, 20u);
}

TEST_F(Materials, ArePrintedWhole) {
    const RunResult printed = graftal("print m.inst");
    ASSERT_EQ(printed.status, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("  transparency: 0.6\n  ior: 1.4\n"));
    write("again.inst", printed.out);
    EXPECT_EQ(graftal("print again.inst").out, printed.out);
}

TEST_F(Materials, PicturesWithHolesAreNoSolids) {
    write("holes.inst",
          "material leaf { texture: \"leaf.png\"  ior: 1.5 }\nobject a { sphere material: leaf }\n");
    const RunResult result = graftal("print holes.inst");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err,
                HasSubstr("holes.inst:1:10: error: the picture of this material has clear parts"));
    EXPECT_THAT(result.err, HasSubstr("leave out 'ior' and 'absorption'"));
}

TEST_F(Materials, BlurIsDrawnByTheNativeEngineAlone) {
    const std::string model = "camera { location: 0, 1, 4  look_at: 0, 0, 0 }\nlight { sun: 1, 2, 1 }\n"
                              "background { zenith: 0, 0, 1  horizon: 1, 1, 1 }\n"
                              "material satin { from: gold  blur: ";
    write("sharp.inst", model + "0 }\nobject a { sphere material: satin }\n");
    write("satin.inst", model + "0.3 }\nobject a { sphere material: satin }\n");
    write("matt.inst", "material a { blur: 0.3  reflection: 0 }\nobject a { sphere material: a }\n");
    EXPECT_THAT(graftal("check matt.inst").err,
                HasSubstr("matt.inst:1:14: error: 'blur' blurs what a surface "));
    const std::string small = " -q --size 48x36 ";
    const RunResult by_povray = graftal("render --engine povray satin.inst --size 48x36 -o p.png");
    EXPECT_EQ(by_povray.status, 0) << by_povray.err;
    EXPECT_THAT(by_povray.err, HasSubstr("POV-Ray's picture shows all mirrors and glass sharp"));
    EXPECT_EQ(graftal("render satin.inst --engine native --threads 1 -o a.png" + small).status, 0);
    EXPECT_EQ(graftal("render satin.inst --engine native --threads 3 -o b.png" + small).status, 0);
    EXPECT_EQ(graftal("render sharp.inst --engine native -o c.png" + small).status, 0);
    EXPECT_EQ(graftal("render satin.inst --engine native --test-listed-lights -o d.png" + small).status, 0);
    EXPECT_EQ(read("a.png"), read("b.png"));
    EXPECT_GT(compare_images(picture("a.png"), picture("c.png")).max, 0.1);
    EXPECT_EQ(compare_images(picture("c.png"), picture("d.png")).max, 0);
    EXPECT_EQ(compare_images(picture("p.png"), picture("d.png"), 2.0 / 255).over_threshold, 0);
}

/// Both engines compute solid patterns, on parts of several sizes and on the ground. A control: without a
/// pattern the picture is another one.
// Found in a stranger's grammar of a million veils: of each path all but 32 surfaces were black.
TEST_F(Materials, AHundredVeilsShowWhatLiesBehind) {
    std::string veils;
    for (int i = 0; i < 100; ++i)
        veils += fmt::format("triangle  scale: 5  translate: 0, 0, {}  material: veil\n", 0.01 * i);
    write("v.inst",
          "material veil { color: 0, 0, 0  ambient: 1  diffuse: 0  specular: 0  transparency: 0.98  "
          "filter: 0 }\nobject stack {\n" +
              veils +
              "}\nbackground: 1, 1, 1\nlight { sun: 0, 0, 1  color: 0, 0, 0 }\n"
              "camera { location: 0, 0, 10  look_at: 0, 0, 0  orthographic  width: 1 }\n");
    for (const std::string engine : {"native", "povray"}) {
        const RunResult drawn = graftal("render v.inst --engine " + engine + " --size 8x8 -q -o v.png");
        ASSERT_EQ(drawn.status, 0) << drawn.err;
        const double shown = picture("v.png").pixels[3 * (8 * 4 + 4)]; // as a screen has it
        EXPECT_NEAR(shown, 1.055 * std::pow(std::pow(0.98, 100), 1 / 2.4) - 0.055, 1.5 / 255) << engine;
    }
}

TEST_F(Materials, PatternsLookAlikeInBothEngines) {
    const auto model = [](const std::string& pattern) {
        return "material a { color: 0.5, 0.4, 0.3 " + pattern + " }\n" +
               "material soil { color: 0.3, 0.25, 0.2 " + pattern + " }\n" + R"(
            canonical object twig { sphere scale: 0.25 translate: 0, 1.4, 0 material a tint: 0, 0.4, 0, 0.3 }
            object o {
                sphere translate: -1.2, 0.2, 0 material a
                cylinder scale: 0.4, 1, 0.4 rotate: z, 20 translate: 1, 0.2, 0 material a
                twig
            }
            ground { height: -0.8 material: soil }
            camera { location: 0, 2, 6 look_at: 0, 0.1, 0 angle: 40 }
            light { sun: -1, 2, 2 }
        )";
    };
    write("plain.inst", model(""));
    const std::string words = " --plain-light --antialias 3 --size 120x80";
    for (const std::string pattern :
         {"pattern: noise scale: 1.2 octaves: 2", "pattern: ridges scale: 1 octaves: 2 warp: 0.5",
          "pattern: cells scale: 1.5 octaves: 1 warp: 0.5 plus: bands scale: 1 octaves: 1 share: 0.4",
          "pattern: rings scale: 0.8 octaves: 1 space: world stretch: 1, 1, 2",
          "pattern: noise scale: 1.5 octaves: 1 bump: 2 low: 0.5, 0.4, 0.3 high: 0.5, 0.4, 0.3"}) {
        SCOPED_TRACE(pattern);
        write("m.inst", model(pattern));
        const ImageDifference engines = engines_differ("m.inst" + words, 0.1);
        EXPECT_LT(engines.mean, 2.5 / 255);
        ASSERT_EQ(graftal("render plain.inst -q --engine native -o plain.png" + words).status, 0);
        EXPECT_GT(compare_images(picture("native.png"), picture("plain.png"), 0.1).mean, 4 * engines.mean);
    }
}

} // namespace
} // namespace graftal
