// What is written row by row has the bytes of what is written at once.

#include <numeric>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/farm/contact_sheet.h"
#include "runtime/farm/join_tiles.h"
#include "runtime/image_files/small_text.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using testing::HasSubstr;

class Merges : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    std::string bytes(const std::string& name) const {
        std::string text;
        EXPECT_TRUE(read_text(path(name), text).ok()) << name;
        return text;
    }
    TemporaryDirectory directory_;
};

Image colourful(int width, int height) {
    Image image{width, height, 3, std::vector<float>(static_cast<std::size_t>(3 * width * height))};
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<float>((i * 7919) % 1009) / 1008.0f;
    return image;
}

Image part_of(const Image& whole, const Tile& tile) {
    Image part{tile.width, tile.height, 3, {}};
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
        const auto first = whole.pixels.begin() + 3 * (y * whole.width + tile.x);
        part.pixels.insert(part.pixels.end(), first, first + 3 * tile.width);
    }
    return part;
}

TEST_F(Merges, TilesMakeTheFileOfTheWholePicture) {
    const Image whole = colourful(101, 70);
    const ImageMetadata metadata{"a program", "a command", ""};
    for (const auto& [ending, format] :
         {std::pair(".png", SampleFormat::srgb8), std::pair(".png", SampleFormat::srgb16),
          std::pair(".png", SampleFormat::linear16), std::pair(".exr", SampleFormat::linear16)}) {
        SCOPED_TRACE(testing::Message() << ending << " " << static_cast<int>(format));
        Job job;
        job.fit = PictureFit{.size = {101, 70}};
        job.tile = {40, 33};
        job.tasks = 9;
        job.result = std::string("joined") + ending;
        const JobFolder folder(directory_.path());
        std::filesystem::create_directories(folder.parts());
        for (std::uint64_t task = 1; task <= job.tasks; ++task)
            ASSERT_TRUE(
                write_image(folder.part(job, task), part_of(whole, job.tile_of(task)), format, {}).ok());
        const Status joined = join_tiles(folder, job, format, metadata, {});
        ASSERT_TRUE(joined.ok()) << joined.message();
        ASSERT_TRUE(write_image(path(std::string("whole") + ending), whole, format, metadata).ok());
        EXPECT_TRUE(bytes(std::string("whole") + ending) == bytes(job.result)) << "the files differ";

        // A tile of another size, none at all, and an interruption: the result stays as it is.
        ASSERT_TRUE(write_image(folder.part(job, 5), colourful(3, 3), format, {}).ok());
        EXPECT_THAT(join_tiles(folder, job, format, {}, {}).message(), HasSubstr("it has 3x3 pixels"));
        std::filesystem::remove(folder.part(job, 5));
        EXPECT_FALSE(join_tiles(folder, job, format, {}, {}).ok());
        EXPECT_EQ(join_tiles(folder, job, format, {}, CancelFlag([] { return true; })).message(),
                  "interrupted");
        EXPECT_TRUE(bytes(std::string("whole") + ending) == bytes(job.result)) << "the result has changed";
    }
}

TEST_F(Merges, ABandIsWhatOneRowOfTilesHolds) {
    EXPECT_EQ(band_bytes({40'000, 30'000}, 400), 40'000u * 400 * 3 * 4);
    EXPECT_LE(band_bytes({40'000, 30'000}, 400), most_band_bytes);
    EXPECT_GT(band_bytes({40'000, 30'000}, 512), most_band_bytes);
}

TEST_F(Merges, AContactSheetHasEachPictureInItsCell) {
    // Of 1 by 1 squares: a reduced one keeps its light, which a mean of encoded samples would not.
    std::vector<SheetPicture> pictures;
    for (int i = 0; i < 5; ++i) {
        Image image{640, 320, 3, {}};
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (int c = 0; c < 3; ++c)
                    image.pixels.push_back(c == i % 3 && (x + y) % 2 == 0 ? 1.0f : 0.0f);
        pictures.push_back(
            {path("picture" + std::to_string(i) + ".png"), i == 3 ? "" : "k=" + std::to_string(i)});
        ASSERT_TRUE(write_image(pictures.back().path, image, SampleFormat::srgb8).ok());
    }
    ASSERT_TRUE(write_contact_sheet(path("sheet.png"), pictures, 2, {}, {}).ok());
    Image sheet;
    ASSERT_TRUE(read_image(path("sheet.png"), sheet).ok());
    ASSERT_EQ(sheet.width, 2 * (320 + 4) + 4);
    ASSERT_EQ(sheet.height, 3 * (160 + 4 + 12) + 4);
    const auto sample = [&](int column, int row, int c) {
        const int x = 4 + column * 324 + 160, y = 4 + row * 176 + 80;
        return sheet.pixels[static_cast<std::size_t>(3 * (y * sheet.width + x) + c)];
    };
    for (int i = 0; i < 5; ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sample(i % 2, i / 2, c), c == i % 3 ? srgb_encoded(0.5f) : 0, 0.003) << i << " " << c;
    EXPECT_EQ(sample(1, 2, 0), 1); // the cell that is left over
    // Labels stand below, black on white.
    const auto ink = [&](int column, int row) {
        int count = 0;
        for (int y = 4 + row * 176 + 160; y < 4 + row * 176 + 172; ++y)
            for (int x = 4 + column * 324; x < 4 + column * 324 + 320; ++x)
                count += sheet.pixels[static_cast<std::size_t>(3 * (y * sheet.width + x))] == 0;
        return count;
    };
    EXPECT_GT(ink(0, 0), 20);
    EXPECT_NE(ink(0, 0), ink(1, 0)); // k=0 and k=1
    EXPECT_EQ(ink(1, 1), 0);         // no label
    EXPECT_EQ(sheet.pixels[0], 1);   // a gap
    EXPECT_FALSE(write_contact_sheet(path("none.png"), {{path("nothing.png"), ""}}, 1, {}, {}).ok());
}

TEST_F(Merges, AContactSheetIsNoWiderThanItMayBe) {
    const std::string picture = path("wide.png");
    ASSERT_TRUE(write_image(picture, colourful(300, 1), SampleFormat::srgb8).ok());
    for (const std::uint64_t columns : {27u, 32u, 5000u}) {
        ASSERT_TRUE(write_contact_sheet(path("sheet.png"), std::vector<SheetPicture>(40, {picture, ""}),
                                        columns, {}, {})
                        .ok());
        Image sheet;
        ASSERT_TRUE(read_image(path("sheet.png"), sheet).ok());
        EXPECT_LE(sheet.width, 8192) << columns;
        EXPECT_GT(sheet.width, 8000) << columns;
    }
}

TEST_F(Merges, ALabelThatDoesNotFitEndsWithDots) {
    const std::string picture = path("narrow.png");
    ASSERT_TRUE(write_image(picture, colourful(60, 20), SampleFormat::srgb8).ok());
    const auto sheet = [&](const std::string& label) {
        EXPECT_TRUE(write_contact_sheet(path("sheet.png"), {{picture, label}}, 1, {}, {}).ok());
        return bytes("sheet.png");
    };
    EXPECT_EQ(sheet("name=1234567"), sheet("name=123..")); // ten letters of six pixels
    EXPECT_NE(sheet("name=12345"), sheet("name=123.."));
}

TEST(SmallText, EveryLetterHasItsOwnShapeInItsOwnBox) {
    std::set<std::vector<float>> shapes;
    for (char letter = ' '; letter <= '~'; ++letter) {
        Image picture{letter_width_px + 8, letter_height_px + 8, 1, {}};
        picture.pixels.assign(static_cast<std::size_t>(picture.width * picture.height), 1);
        write_small_text(std::string(1, letter), 4, 4, 0, picture);
        EXPECT_TRUE(shapes.insert(picture.pixels).second) << letter;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x)
                if (x < 4 || y < 4 || x >= 4 + letter_width_px || y >= 4 + letter_height_px) {
                    EXPECT_EQ(picture.pixels[static_cast<std::size_t>(y * picture.width + x)], 1) << letter;
                }
    }
    // Outside of the picture, in part or wholly; bytes that are no letters.
    Image small{3, 3, 3, std::vector<float>(27, 1)};
    write_small_text("\xc3\n", -4, -4, 0, small);
    write_small_text("far", 1000, -1000, 0, small);
    EXPECT_EQ(small.pixels.size(), 27U);
}

} // namespace
} // namespace graftal
