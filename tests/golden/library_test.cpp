// The library and the command line draw one picture.

#include "tests/golden/command_line.h"

#include "runtime/graftal/model.h"

namespace graftal {
namespace {

class Library : public CommandLine {
  protected:
    /// The picture in memory, and that of `render` in a file, sample by sample.
    void expect_same_picture(const std::string& model) const {
        write("m.inst", model);
        const RunResult run = graftal("render m.inst --engine native -q -o m.png --size 96x54");
        ASSERT_EQ(run.status, 0) << run.err;
        v1::Model library = v1::Model::from_file(path("m.inst"));
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

} // namespace
} // namespace graftal
