#include "runtime/image_files/exr_files.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

class ExrFiles : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    std::string bytes(const std::string& name) const {
        std::ifstream file(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    TemporaryDirectory directory_;
};

/// Of bits that are any at all: infinities, what is no number, and what is hardly one.
Image noise(int width, int height, int channels) {
    Image image{width, height, channels, {}};
    std::mt19937 random(static_cast<unsigned>(width * 100 + channels));
    for (int i = 0; i < width * height * channels; ++i)
        image.pixels.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
    return image;
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& samples) {
    std::vector<std::uint32_t> bits;
    for (const float sample : samples)
        bits.push_back(std::bit_cast<std::uint32_t>(sample));
    return bits;
}

/// OpenImageIO reads what OpenEXR's core library has written.
TEST_F(ExrFiles, KeepEveryBit) {
    for (const int channels : {1, 2, 3, 4})
        for (const auto& [width, height] : {std::pair{1, 1}, {5, 16}, {3, 17}, {64, 100}}) {
            SCOPED_TRACE(testing::Message() << width << "x" << height << "x" << channels);
            const Image image = noise(width, height, channels);
            ASSERT_EQ(write_exr(path("a.exr"), image, {}, nullptr), "");
            Image back;
            ASSERT_TRUE(read_image(path("a.exr"), back).ok());
            EXPECT_EQ(back.channels, channels);
            EXPECT_EQ(bits_of(back.pixels), bits_of(image.pixels));
        }
}

/// Small pictures of few values become about as large as they were.
TEST_F(ExrFiles, KeepWhatCompressesToItsOwnSize) {
    int of_own_size = 0;
    for (int width = 1; width <= 12; ++width)
        for (const int values : {2, 5, 16, 64}) {
            Image image{width, 1, 3, {}};
            for (int i = 0; i < 3 * width; ++i)
                image.pixels.push_back(static_cast<float>(i * 7 % values) / 4);
            ASSERT_EQ(write_exr(path("a.exr"), image, {}, nullptr), "");
            Image back;
            ASSERT_TRUE(read_image(path("a.exr"), back).ok());
            ASSERT_EQ(back, image) << width << " " << values;
            const std::string all = bytes("a.exr");
            std::vector<std::array<char, 4>> planes; // blue first, as OpenEXR sorts them
            for (const int channel : {2, 1, 0})
                for (int x = 0; x < width; ++x)
                    planes.push_back(std::bit_cast<std::array<char, 4>>(
                        image.pixels[static_cast<std::size_t>(3 * x + channel)]));
            const std::string raw(planes.front().data(), 4 * planes.size());
            of_own_size += all.ends_with(raw);
        }
    EXPECT_GT(of_own_size, 0);
}

TEST_F(ExrFiles, OfPovraysKindAreReadAsOpenImageIoReadsThem) {
    for (const int channels : {3, 4})
        for (const int height : {1, 16, 37}) {
            const Image image = noise(19, height, channels);
            ASSERT_EQ(write_exr(path("a.exr"), image, {}, nullptr), "");
            Image back;
            ASSERT_TRUE(read_povray_exr(path("a.exr"), 1 << 20, back));
            EXPECT_EQ(bits_of(back.pixels), bits_of(image.pixels));
            EXPECT_FALSE(read_povray_exr(path("a.exr"), 19u * height * channels - 1, back)) << "too large";
        }
    Image back;
    ASSERT_EQ(write_exr(path("grey.exr"), noise(2, 2, 1), {}, nullptr), "");
    EXPECT_FALSE(read_povray_exr(path("grey.exr"), 100, back));
    std::ofstream(path("no.exr")) << "v/1\x01 this is none";
    EXPECT_FALSE(read_povray_exr(path("no.exr"), 100, back));
    EXPECT_FALSE(read_povray_exr(path("nowhere.exr"), 100, back));
    std::ofstream(path("cut.exr"), std::ios::binary) << bytes("a.exr").substr(0, bytes("a.exr").size() / 2);
    EXPECT_FALSE(read_povray_exr(path("cut.exr"), 1 << 20, back));
}

TEST_F(ExrFiles, AreTheSameByRows) {
    const ImageMetadata metadata{"graftal", "graftal render a.inst", "mark"};
    const Image image = noise(13, 37, 3);
    ImageRows rows(image);
    ASSERT_EQ(write_exr(path("a.exr"), image, metadata, nullptr), "");
    ASSERT_EQ(write_exr_rows(path("b.exr"), {13, 37, 3}, rows, metadata), "");
    EXPECT_EQ(bytes("a.exr"), bytes("b.exr"));
    for (const std::string& text : {metadata.software, metadata.description, metadata.stamp})
        EXPECT_NE(bytes("a.exr").find(text), std::string::npos) << text;
}

class Broken : public RowSource {
  public:
    std::string give(float* samples) override {
        samples[0] = 0;
        return ++rows_ > 20 ? "no more rows" : "";
    }

  private:
    int rows_ = 0;
};

TEST_F(ExrFiles, SayWhatWentWrong) {
    const Image image = noise(64, 64, 3);
    EXPECT_EQ(write_exr("/dev/full", image, {}, nullptr), "No space left on device");
    ImageRows rows(image);
    EXPECT_EQ(write_exr_rows("/dev/full", {64, 64, 3}, rows, {}), "No space left on device");
    EXPECT_EQ(write_exr(path("nowhere/a.exr"), image, {}, nullptr), "No such file or directory");
    Broken broken;
    EXPECT_EQ(write_exr_rows(path("a.exr"), {1, 100, 3}, broken, {}), "no more rows");
}

} // namespace
} // namespace graftal
