// The library and the command line draw one picture.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/golden/command_line.h"

#include "runtime/graftal/model.h"

namespace graftal {
namespace {

class Library : public CommandLine {
  protected:
    /// The picture in memory, and that of `render` in a file, sample by sample.
    void expect_same_picture(const std::string& model, const std::string& file_name = "m.inst",
                             std::uint64_t seed = 0) const {
        write(file_name, model);
        const RunResult run = graftal("render " + file_name + " --seed " + std::to_string(seed) +
                                      " --engine native -q -o m.png --size 96x54");
        ASSERT_EQ(run.status, 0) << run.err;
        v1::Model library = v1::Model::from_file(path(file_name));
        library.seed(seed);
        library.size(96, 54);
        const auto drawn = library.render();
        ASSERT_TRUE(drawn) << drawn.text();
        const Image file = picture("m.png");
        ASSERT_EQ(file.channels, 3);
        ASSERT_EQ(file.pixels.size(), drawn->rgb.size());
        for (std::size_t i = 0; i < drawn->rgb.size(); ++i)
            ASSERT_EQ(file.pixels[i], static_cast<float>(drawn->rgb[i]) / 255.0f) << "sample " << i;
    }
};

TEST_F(Library, APlainPictureIsThatOfTheProgram) {
    expect_same_picture("object m { instance: sphere  instance: cube translate: 1, 0, -2 }\n");
}

TEST_F(Library, APictureUnderASkyIsThatOfTheProgram) {
    expect_same_picture("sky { zenith: 0.3, 0.4, 0.7  horizon: 0.9, 0.8, 0.7  bounces: 1 }\n"
                        "object m { instance: sphere }\n");
}

TEST_F(Library, AFilmIsDevelopedAsByTheProgram) {
    expect_same_picture("film { exposure: 1.7  white: 4500  soft }\n"
                        "object m { instance: sphere  instance: cube translate: 1, 0, -2 }\n");
}

// Found by grammars that --seed did not change.
TEST_F(Library, ASeedDrawsAnotherVariationOfAGrammar) {
    const std::string grammar = "startshape A\nshape A { SQUARE [] CIRCLE [x (rand(2, 9))] }\n";
    expect_same_picture(grammar, "g.cfdg", 7);
    const std::vector<float> drawn = picture("m.png").pixels;
    expect_same_picture(grammar, "g.cfdg");
    EXPECT_NE(picture("m.png").pixels, drawn);
    const std::vector<std::pair<std::string, std::string>> commands = {
        {"import g.cfdg", ""},
        {"print g.cfdg", ""},
        {"check g.cfdg --dump-after all", ""},
        {"stats g.cfdg", ""},
        {"compile g.cfdg -q -o a.inc", " && cat a.inc"}};
    for (const auto& [command, then] : commands) {
        const auto said = [&, &command = command, &then = then](const std::string& seed) {
            // Files tell of the command that wrote them, and so of the seed.
            const RunResult run = shell("($graftal " + command + seed + then + ") 2>&1 | grep -v seed");
            EXPECT_EQ(run.status, 0) << command << run.out;
            return run.out;
        };
        EXPECT_EQ(said(" --seed 0"), said("")) << command;
        EXPECT_NE(said(" --seed 7"), said("")) << command;
    }
}

} // namespace
} // namespace graftal
