// A leaf by recursion, as a mesh, and as a card with its picture: from the size at which they take each
// other's place they look alike, as docs/points.md says (scenes/plants/maple_leaf.rifs,
// maple_leaf_card.inst).

#include "tests/golden/command_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "runtime/image/image.h"

namespace graftal {
namespace {

/// Of what is drawn in front of the background.
struct Look {
    double coverage = 0;
    std::array<double, 3> rgb{}; ///< as displays have it, 0 to 255
};

double displayed(double linear) {
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

class Bodies : public CommandLine {
  protected:
    /// Sixty leaves that lean and turn, `size_px` long.
    Look look_of(const std::string& leaf, double size_px, const std::string& options) {
        const std::string own = leaf == "own" ? "use own = \"leaf.inst\"\n" : "";
        std::array<std::array<double, 3>, 2> means{};
        for (const int shade : {0, 1}) {
            const std::string name = shade ? "white" : "black";
            write(name + ".inst",
                  own + "use maple = \"" + source_path("scenes/plants/maple_leaf.rifs") +
                      "\"\nuse card = \"" + source_path("scenes/plants/maple_leaf_card.inst") +
                      "\"\ncamera { location: 0,0,10 look_at: 0,0,0 orthographic width: 0.7 }\n"
                      "light { sun: 0.3,0.4,1 color: 1,1,1 }\nbackground: " +
                      (shade ? "1,1,1" : "0,0,0") + "\ncanonical object leaf { " + leaf +
                      " }\nobject o { scatter: leaf count: 60 over: -0.3,-0.3,0.3,0.3 by: jitter turn: y "
                      "lean: 0..70 size: 0.05 rotate: x, 90 }\n");
            const std::string size = std::to_string(std::lround(0.7 / 0.05 * size_px));
            const RunResult run = graftal("render " + name + ".inst -q --plain-light --antialias 2 --size " +
                                          size + "x" + size + " -o " + name + ".exr " + options);
            EXPECT_EQ(run.status, 0) << run.err;
            means[static_cast<std::size_t>(shade)] = mean(picture(name + ".exr"));
        }
        Look look;
        for (std::size_t k = 0; k < 3; ++k)
            look.coverage += (1 - (means[1][k] - means[0][k])) / 3;
        for (std::size_t k = 0; k < 3; ++k)
            look.rgb[k] = displayed(means[0][k] / look.coverage);
        return look;
    }

  private:
    static std::array<double, 3> mean(const Image& image) {
        std::array<double, 3> sum{};
        const auto channels = static_cast<std::size_t>(image.channels);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            if (i % channels < 3) sum[i % channels] += static_cast<double>(image.pixels[i]);
        for (double& value : sum)
            value /= static_cast<double>(image.pixels.size() / channels);
        return sum;
    }
};

void expect_alike(const Look& look, const Look& recursion) {
    EXPECT_NEAR(look.coverage / recursion.coverage, 1, 0.02);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(look.rgb[k], recursion.rgb[k], 2) << "channel " << k;
}

TEST_F(Bodies, LookAlikeWhereTheyTakeEachOthersPlace) {
    constexpr double size_px = 32;
    const Look recursion = look_of("maple", size_px, "--engine native");
    EXPECT_GT(recursion.coverage, 0.05);
    const std::string changing = "instance: maple terminal: card below: ";
    struct Case {
        std::string leaf, options;
    };
    for (const Case& other :
         {Case{"maple", "--engine povray"}, Case{"card", "--engine native"}, Case{"card", "--engine povray"},
          Case{changing + "50", "--engine native"}, Case{changing + "50", "--engine povray"}}) {
        SCOPED_TRACE(other.leaf + " " + other.options);
        expect_alike(look_of(other.leaf, size_px, other.options), recursion);
    }
}

/// As the command makes it, without choosing anything.
TEST_F(Bodies, ACardOfPointsStandsForItsModel) {
    ASSERT_EQ(
        graftal("points -q '" + source_path("scenes/plants/maple_leaf.rifs") + "' --card leaf.inst").status,
        0);
    const Look recursion = look_of("maple", 32, "--engine native");
    const Look card = look_of("own", 32, "--engine native");
    EXPECT_NEAR(card.coverage / recursion.coverage, 1, 0.03);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(card.rgb[k], recursion.rgb[k], 3) << "channel " << k;
    EXPECT_EQ(graftal("points -q x.rifs --card leaf.rifs").status, 2);
    EXPECT_EQ(graftal("points -q x.rifs --card leaf.inst -o other/leaf.png").status, 2);
    EXPECT_EQ(graftal("points -q x.rifs --card leaf.inst -o 'le\"af.png'").status, 2);
}

/// A terminal that is nothing like its object tells which of the two is drawn.
TEST_F(Bodies, ChangeAtTheSizeThatIsSaid) {
    const std::string changing = "instance: maple terminal: cube scale: 0.001 below: ";
    for (const std::string engine : {"native", "povray"}) {
        SCOPED_TRACE(engine);
        const Look maple = look_of("maple", 16, "--engine " + engine);
        EXPECT_NEAR(look_of(changing + "12", 16, "--engine " + engine).coverage / maple.coverage, 1, 1e-3);
        EXPECT_LT(look_of(changing + "30", 16, "--engine " + engine).coverage, 0.1 * maple.coverage);
        EXPECT_NEAR(look_of(changing + "30", 16, "--error-world 0.001 --engine " + engine).coverage /
                        maple.coverage,
                    1, 0.05)
            << "an error in scene units knows no pixels";
    }
}

} // namespace
} // namespace graftal
