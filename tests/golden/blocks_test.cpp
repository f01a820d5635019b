// `graftal fit --blocks`, and `graftal render` of its files.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "runtime/image_files/image_files.h"
#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using testing::HasSubstr;

class Blocks : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        ASSERT_EQ(
            graftal("points -q '" + source_path("scenes/ifs/fern.rifs") + "' --size 96x80 -o t.png").status,
            0);
    }
};

TEST_F(Blocks, CodeAPictureAndDecodeItAtAnySize) {
    const RunResult coded = graftal("fit --blocks t.png --tolerance 4");
    ASSERT_EQ(coded.status, 0) << coded.err;
    for (const char* words : {"t.pifs: ", " bytes for 96x80 pixels, ", "error ", "PSNR ", "collage ",
                              "every slope is at most ", "blocks ", "work "})
        EXPECT_THAT(coded.err, HasSubstr(words));
    const RunResult drawn = graftal("render t.pifs -o again.png");
    ASSERT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_THAT(drawn.err, HasSubstr("again.png: 96x80 pixels"));
    const nlohmann::json json = nlohmann::json::parse(
        graftal("fit --blocks t.png --tolerance 4 --threads 1 -o u.pifs --json -q").out);
    EXPECT_EQ(read("t.pifs"), read("u.pifs"));
    EXPECT_EQ(json["bytes"], read("t.pifs").size());
    EXPECT_LT(json["rms"], 8);
    EXPECT_LE(json["contraction"], 0.875);
    EXPECT_LT(255 * compare_images(picture("t.png"), picture("again.png")).rms, 12);
    ASSERT_EQ(graftal("render t.pifs --size 200x170 --bits 16 -q --threads 1 -o large.png").err, "");
    EXPECT_EQ(picture("large.png").width, 200);
    ASSERT_EQ(graftal("render t.pifs --size 200x170 --bits 16 -q -o other.png").err, "");
    EXPECT_EQ(compare_images(picture("large.png"), picture("other.png")).max, 0);
    EXPECT_EQ(files(), "again.png large.png other.png t.pifs t.png u.pifs");
    EXPECT_EQ(temporary_files(), "");
}

TEST_F(Blocks, FaultsAreNamed) {
    ASSERT_EQ(graftal("fit --blocks t.png --tolerance 30 -q").err, "");
    write("cut.pifs", read("t.pifs").substr(0, 100));
    write("no.pifs", "lsys");
    const struct {
        std::string arguments;
        int status;
        std::string message;
    } cases[] = {
        {"fit --blocks t.png -o t.rifs", 2, "'t.rifs': the name of the model must end in .pifs"},
        {"fit --blocks t.png --maps 3", 2, "--blocks"},
        {"fit t.png --tolerance 3", 2, "--tolerance is for drawings"},
        {"fit --blocks t.png --tolerance -1", 2, "--tolerance: '-1' is not a number from 0 to 255"},
        {"fit --blocks none.png", 3, "none.png"},
        {"fit --blocks t.png --memory 64K", 1, "has 96x80 pixels: to code them takes 1 MiB"},
        {"fit --blocks t.png --work 0.001", 1, "would take more work than 0.001 seconds"},
        {"render t.pifs --camera width=3", 2, "--camera: a .pifs file holds the blocks of a picture"},
        {"render t.pifs --steps 3", 2, "--steps: a .pifs file"},
        {"render t.pifs -o t.exr", 2, "a .pifs file is decoded to a PNG"},
        {"render none.pifs", 3, "none.pifs"},
        {"render cut.pifs", 1, "cannot read 'cut.pifs': it is cut off"},
        {"render no.pifs", 1, "it does not begin with PIFS"},
        {"render t.pifs --memory 1M --size 2000x2000", 1, "to decode 't.pifs' to 2000x2000 pixels takes"},
        {"render t.pifs --work 0.01 --size 3000x3000", 1, "allow more with --work"},
        {"points t.pifs", 1, ""},
    };
    for (const auto& [arguments, status, message] : cases) {
        const RunResult result = graftal(arguments);
        EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
        EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    }
    EXPECT_EQ(files(), "cut.pifs no.pifs t.pifs t.png");
}

} // namespace
} // namespace graftal
