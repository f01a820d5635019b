// Pictures whose noise is taken out, against those of many samples.

#include "tests/golden/command_line.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/image/image.h"

namespace graftal {
namespace {

class DenoisedPictures : public CommandLine {
  protected:
    Image draw(const std::string& scene, const std::string& options) const {
        const RunResult result =
            graftal("render " + source_path("scenes/" + scene) +
                    " --engine native --size 160x90 --noise 0 --work 1000 -o a.png " + options);
        EXPECT_EQ(result.status, 0) << result.err;
        return picture("a.png");
    }
};

/// Fractals are nearly all edges, and plants too.
TEST_F(DenoisedPictures, AreNearerToTheTruthThanTheirSamples) {
    for (const std::string scene : {"ifs/menger_sponge.rifs", "hart/elm.inst", "hart/pound_sign.rifs"}) {
        const Image truth = draw(scene, "--samples 256 --denoise off");
        const auto error = [&](int samples, const char* denoise) {
            return compare_images(truth,
                                  draw(scene, fmt::format("--samples {} --denoise {}", samples, denoise)))
                .rms;
        };
        for (const int samples : {2, 4, 8})
            EXPECT_LT(error(samples, "on"), 0.75 * error(samples, "off")) << scene << samples;
        EXPECT_LT(error(32, "on"), 1.05 * error(32, "off")) << scene;
    }
}

TEST_F(DenoisedPictures, AreTheSameOnAnyNumberOfThreadsAndPasses) {
    const Image one = draw("hart/elm.inst", "--samples 8 --threads 1 --no-progressive");
    EXPECT_EQ(one, draw("hart/elm.inst", "--samples 8 --threads 3"));
    EXPECT_NE(one, draw("hart/elm.inst", "--samples 8 --denoise off"));
    EXPECT_EQ(draw("hart/elm.inst", "--samples 8 --quality best"),
              draw("hart/elm.inst", "--samples 8 --quality best --denoise off"));
}

/// Work that is too short for two samples a pixel goes into some of the pixels.
TEST_F(DenoisedPictures, SparseSamplesFillThePicture) {
    const std::string scene = "surroundings/cherry.lsys";
    const Image truth = draw(scene, "--samples 64");
    const auto drawn = [&](const std::string& denoise) {
        const RunResult result =
            graftal("render " + source_path("scenes/" + scene) +
                    " --engine native --size 160x90 --work 0.65 --no-progressive -o a.png "
                    "--denoise " +
                    denoise);
        EXPECT_EQ(result.status, 0) << result.err;
        return compare_images(truth, picture("a.png")).rms;
    };
    EXPECT_LT(drawn("on"), 0.9 * drawn("off"));
}

} // namespace
} // namespace graftal
