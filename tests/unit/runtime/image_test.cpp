#include "runtime/image_files/image_files.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

class ImageFiles : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    std::string bytes(const std::string& name) const {
        std::ifstream file(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::size_t file_count() const {
        const std::filesystem::directory_iterator files(directory_.path());
        return static_cast<std::size_t>(std::distance(begin(files), end(files)));
    }

    TemporaryDirectory directory_;
};

/// Writes and commits.
template<typename... Arguments> Status save_palette(const std::string& path, const Arguments&... arguments) {
    PendingFile pending(path);
    const Status status = write_palette(pending, arguments...);
    return status.ok() ? pending.commit() : status;
}

/// width x 1 RGB ramp of k / largest.
Image ramp(int width, int largest) {
    Image image{width, 1, 3, {}};
    for (int k = 0; k < 3 * width; ++k)
        image.pixels.push_back(static_cast<float>(k % (largest + 1)) / static_cast<float>(largest));
    return image;
}

TEST_F(ImageFiles, Png8KeepsEveryLevel) {
    const Image image = ramp(256, 255);
    ASSERT_TRUE(write_image(path("a.png"), image, SampleFormat::srgb8).ok());
    Image back;
    ASSERT_TRUE(read_image(path("a.png"), back).ok());
    EXPECT_EQ(back, image);
}

/// Else no two files would be the same.
TEST_F(ImageFiles, NoFileHoldsTheTime) {
    for (const char* name : {"a.exr", "a.png"}) {
        ASSERT_TRUE(write_image(path(name), ramp(2, 255), SampleFormat::srgb8).ok());
        EXPECT_THAT(bytes(name), testing::Not(testing::ContainsRegex("[0-9][0-9]:[0-9][0-9]:[0-9][0-9]")))
            << name;
    }
}

TEST_F(ImageFiles, Png16KeepsEveryLevel) {
    const Image image = ramp(22000, 65535);
    ASSERT_TRUE(write_image(path("a.png"), image, SampleFormat::linear16).ok());
    Image back;
    ASSERT_TRUE(read_image(path("a.png"), back).ok());
    EXPECT_EQ(back, image);
}

TEST_F(ImageFiles, ExrKeepsFloatsBeyondOneAndBelowZero) {
    const Image image{2, 1, 3, {-1.5f, 0, 1e-9f, 1.0f / 3, 1e9f, 2}};
    ASSERT_TRUE(write_image(path("a.EXR"), image, SampleFormat::srgb8).ok());
    Image back;
    ASSERT_TRUE(read_image(path("a.EXR"), back).ok());
    EXPECT_EQ(back, image);
}

TEST_F(ImageFiles, PngAlphaIsStraight) {
    const Image image{2, 1, 4, {1, 0, 0, 0, 1, 1, 0, 51.0f / 255}};
    ASSERT_TRUE(write_image(path("a.png"), image, SampleFormat::srgb8).ok());
    Image back;
    ASSERT_TRUE(read_image(path("a.png"), back).ok());
    EXPECT_EQ(back, image);
}

TEST_F(ImageFiles, BytesDependOnTheArgumentsOnly) {
    const ImageMetadata metadata{"graftal 0.1", "graftal render 'a b.rifs'"};
    for (const char* name : {"a.png", "b.png"})
        ASSERT_TRUE(write_image(path(name), ramp(64, 255), SampleFormat::srgb8, metadata).ok());
    EXPECT_EQ(bytes("a.png"), bytes("b.png"));
}

TEST_F(ImageFiles, PngSaysWhoMadeItAndHowItIsEncoded) {
    const ImageMetadata metadata{"graftal 0.1", "graftal render m.rifs"};
    ASSERT_TRUE(write_image(path("a.png"), ramp(4, 255), SampleFormat::srgb8, metadata).ok());
    ASSERT_TRUE(write_image(path("b.png"), ramp(4, 255), SampleFormat::linear16, metadata).ok());
    EXPECT_THAT(bytes("a.png"),
                testing::AllOf(testing::HasSubstr("graftal 0.1"), testing::HasSubstr("graftal render m.rifs"),
                               testing::HasSubstr("sRGB")));
    // gAMA holds 100000 / gamma, big-endian: 100000 = 0x000186A0.
    EXPECT_THAT(bytes("b.png"), testing::HasSubstr(std::string("gAMA\0\x01\x86\xA0", 8)));
}

TEST_F(ImageFiles, PaletteHoldsLinearValuesRounded) {
    ASSERT_TRUE(save_palette(path("p.png"), 2, 1, std::vector{Rgb(0.5, 1.0 / 3, 0), Rgb(1, 2, -1)}).ok());
    Image back;
    ASSERT_TRUE(read_image(path("p.png"), back).ok());
    const auto level = [](double k) { return static_cast<float>(k / 65535); };
    EXPECT_THAT(back.pixels, testing::ElementsAre(level(32768), level(21845), 0, 1, 1, 0));
}

TEST_F(ImageFiles, PaletteThatEndsEarlyIsFilledWithItsLastColour) {
    ASSERT_TRUE(save_palette(path("p.png"), 2, 2, std::vector{Rgb(0), Rgb(1)}).ok());
    Image back;
    ASSERT_TRUE(read_image(path("p.png"), back).ok());
    EXPECT_EQ(back.height, 2);
    EXPECT_THAT(back.pixels, testing::ElementsAre(0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1));
}

TEST_F(ImageFiles, PaletteThatCannotBeWrittenIsAFailure) {
    EXPECT_THAT(save_palette(path("none/p.png"), 1, 1, std::vector{Rgb(0)}).message(),
                testing::HasSubstr("none/p.png"));
}

TEST_F(ImageFiles, MissingFileAndNoPictureAreFailures) {
    Image image;
    EXPECT_FALSE(read_image(path("none.png"), image).ok());
    std::ofstream(path("text.png")) << "this is no picture";
    const Status status = read_image(path("text.png"), image);
    EXPECT_THAT(status.message(), testing::HasSubstr("text.png"));
    EXPECT_EQ(status.message().find('\n'), std::string::npos);
    EXPECT_FALSE(read_image(directory_.path(), image).ok());
}

TEST_F(ImageFiles, TruncatedPngIsAFailure) {
    ASSERT_TRUE(write_image(path("a.png"), ramp(256, 255), SampleFormat::srgb8).ok());
    const std::string whole = bytes("a.png");
    std::ofstream(path("b.png"), std::ios::binary) << whole.substr(0, whole.size() / 2);
    Image image;
    EXPECT_FALSE(read_image(path("b.png"), image).ok());
}

TEST_F(ImageFiles, FailedWriteLeavesNothing) {
    std::filesystem::create_directory(path("a.png"));
    EXPECT_FALSE(write_image(path("a.png"), ramp(4, 255), SampleFormat::srgb8).ok());
    EXPECT_FALSE(write_image(path("no/such/folder.png"), ramp(4, 255), SampleFormat::srgb8).ok());
    EXPECT_EQ(file_count(), 1u);
}

TEST(CompareImages, NinetyNineOfAHundredPixels) {
    const Image a{200, 1, 1, std::vector<float>(200, 0.0f)};
    Image b = a;
    EXPECT_EQ(compare_images(a, b).p99, 0);
    b.pixels[7] = 1;
    b.pixels[90] = 0.5;
    EXPECT_EQ(compare_images(a, b).p99, 0) << "two of 200 may be farther apart";
    b.pixels[199] = 0.25;
    EXPECT_EQ(compare_images(a, b).p99, 0.25);
    EXPECT_EQ(compare_images({1, 1, 1, {0}}, {1, 1, 1, {1}}).p99, 1);
}

TEST(ImageNames, OnlyPngAndExrAreWritten) {
    for (const char* name : {"a.png", "a.PNG", "dir.x/b.exr", ".hidden.Exr"})
        EXPECT_TRUE(is_picture_name(name)) << name;
    for (const char* name : {"", "png", "a.jpg", "a.png/b", "a.png.", "a.pngx"})
        EXPECT_FALSE(is_picture_name(name)) << name;
}

TEST(Compare, FollowsTheFormulas) {
    const Image a{2, 1, 3, {0, 0, 0, 1, 1, 1}};
    const Image b{2, 1, 3, {0, 0, 0.5f, 1, 0.75f, 1}};
    const ImageDifference d = compare_images(a, b, 0.3);
    EXPECT_TRUE(d.same_size);
    EXPECT_DOUBLE_EQ(d.max, 0.5);
    EXPECT_DOUBLE_EQ(d.mean, 0.75 / 6);
    EXPECT_DOUBLE_EQ(d.rms, std::sqrt((0.25 + 0.0625) / 6));
    EXPECT_EQ(d.over_threshold, 1u);
    EXPECT_EQ(d.differing, 2u);
    EXPECT_EQ(d.pixels, 2u);
}

TEST(Compare, AnEqualPictureIsNoDistanceAway) {
    const Image a = ramp(100, 255);
    const ImageDifference d = compare_images(a, a);
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(d.rms, 0);
    EXPECT_EQ(d.differing, 0u);
}

TEST(Compare, DifferenceOfExactlyTheThresholdIsNotOverIt) {
    const Image a{1, 1, 1, {0.25f}}, b{1, 1, 1, {0.5f}};
    EXPECT_EQ(compare_images(a, b, 0.25).over_threshold, 0u);
    EXPECT_EQ(compare_images(a, b, 0.2499).over_threshold, 1u);
}

TEST(Compare, SizesMustAgree) {
    EXPECT_FALSE(compare_images(Image{2, 1, 1, {0, 0}}, Image{1, 2, 1, {0, 0}}).same_size);
}

TEST(Compare, GreyCountsAsRgbAndMissingAlphaAsOne) {
    EXPECT_EQ(compare_images(Image{1, 1, 1, {0.5f}}, Image{1, 1, 4, {0.5f, 0.5f, 0.5f, 1}}).max, 0);
    EXPECT_EQ(compare_images(Image{1, 1, 2, {0.5f, 0.25f}}, Image{1, 1, 3, {0.5f, 0.5f, 0.5f}}).max, 0.75);
}

TEST(Compare, NanAgreesWithNanOnly) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(compare_images(Image{1, 1, 1, {nan}}, Image{1, 1, 1, {nan}}).max, 0);
    EXPECT_EQ(compare_images(Image{1, 1, 1, {infinity}}, Image{1, 1, 1, {infinity}}).max, 0);
    const ImageDifference d = compare_images(Image{1, 1, 1, {nan}}, Image{1, 1, 1, {0}}, 1);
    EXPECT_TRUE(std::isinf(d.max));
    EXPECT_EQ(d.over_threshold, 1u);
}

TEST(Compare, NoPixelsNoDivisionByZero) {
    EXPECT_EQ(compare_images(Image{}, Image{}).mean, 0);
}

} // namespace
} // namespace graftal
