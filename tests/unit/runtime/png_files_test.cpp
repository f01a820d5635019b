#include "runtime/image_files/png_files.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/image_files/png_chunks.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint64_t plenty = 1 << 20;

class PngFiles : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    std::string bytes(const std::string& name) const {
        std::ifstream file(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    Image read(const std::string& name) const {
        Image image;
        ImageSink sink(image, plenty);
        EXPECT_EQ(read_png(path(name), sink), "") << name;
        return image;
    }
    Image read_bytes(const std::string& file) const {
        put(file);
        return read("bytes.png");
    }
    std::string error_of(const std::string& file) const {
        put(file);
        Image image;
        ImageSink sink(image, plenty);
        return read_png(path("bytes.png"), sink);
    }

    TemporaryDirectory directory_;

  private:
    void put(const std::string& file) const { std::ofstream(path("bytes.png"), std::ios::binary) << file; }
};

/// Levels 0, 1, 2, ... of a picture that uses all of them, times a step.
Image levels(int width, int height, int channels, int largest) {
    Image image{width, height, channels, {}};
    for (int i = 0; i < width * height * channels; ++i)
        image.pixels.push_back(static_cast<float>(i * 37 % (largest + 1)) / static_cast<float>(largest));
    return image;
}

/// Does not compress to less than it is.
Image noise(int width, int height) {
    Image image{width, height, 3, {}};
    std::uint32_t state = 1;
    for (int i = 0; i < 3 * width * height; ++i) {
        state = state * 1664525u + 1013904223u;
        image.pixels.push_back(static_cast<float>(state >> 24) / 255.0f);
    }
    return image;
}

/// What RFC 1950 wraps around one stored block.
std::string stored(const std::string& data) {
    std::uint32_t a = 1, b = 0;
    for (const char c : data) {
        a = (a + static_cast<unsigned char>(c)) % 65521;
        b = (b + a) % 65521;
    }
    const auto low = static_cast<char>(data.size() & 0xff), high = static_cast<char>(data.size() >> 8);
    return std::string("\x78\x01\x01") + low + high + static_cast<char>(~low) + static_cast<char>(~high) +
           data + big_endian(b << 16 | a);
}

struct Header {
    std::uint32_t width, height;
    int bits, colour_type, interlaced = 0;
};

/// A file as other programs may write it. Each row of `rows` begins with its filter.
std::string png_of(const Header& header, const std::string& rows, const std::string& chunks = {}) {
    return std::string(png_signature) +
           png_chunk("IHDR", big_endian(header.width) + big_endian(header.height) +
                                 big_endian(static_cast<std::uint32_t>(header.bits), 1) +
                                 big_endian(static_cast<std::uint32_t>(header.colour_type), 1) +
                                 std::string(2, '\0') +
                                 big_endian(static_cast<std::uint32_t>(header.interlaced), 1)) +
           chunks + png_chunk("IDAT", stored(rows)) + png_chunk("IEND", {});
}

std::vector<std::string> types_in(const std::string& file) {
    std::vector<std::string> types;
    const std::vector<PngChunk> chunks = png_chunks(file).value();
    for (const PngChunk& chunk : chunks)
        types.emplace_back(chunk.type);
    return types;
}

TEST_F(PngFiles, EveryKindComesBack) {
    const int colour_types[] = {0, 4, 2, 6};
    for (int channels = 1; channels <= 4; ++channels)
        for (const SampleFormat format :
             {SampleFormat::srgb8, SampleFormat::srgb16, SampleFormat::linear16}) {
            const int bits = format == SampleFormat::srgb8 ? 8 : 16;
            const Image image = levels(150, 120, channels, (1 << bits) - 1);
            ASSERT_EQ(write_png(path("a.png"), image, format, {}), "");
            EXPECT_EQ(read("a.png"), image) << channels << " " << bits;
            const std::string file = bytes("a.png");
            const std::string_view header = png_chunks(file).value().front().data;
            EXPECT_EQ(header.substr(0, 8), big_endian(150) + big_endian(120));
            EXPECT_THAT(std::vector<int>(header.begin() + 8, header.end()),
                        ElementsAre(bits, colour_types[channels - 1], 0, 0, 0));
        }
}

TEST_F(PngFiles, SamplesAreClampedAndRoundedHalvesUp) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float below_half = 0x1.0101p-9f; // times 255 it is the float just below 1/2; with 1/2 added it is 1
    const std::vector<float> values = {-1, -0.0f, below_half, 0.5f, 1, 1.5f, 1e30f, infinity, -infinity, nan};
    const Image image{static_cast<int>(values.size()), 1, 1, values};
    const auto levels_as = [&](SampleFormat format, float largest) {
        EXPECT_EQ(write_png(path("a.png"), image, format, {}), "");
        Image back = read("a.png");
        for (float& value : back.pixels)
            value *= largest;
        return back.pixels;
    };
    EXPECT_THAT(levels_as(SampleFormat::srgb8, 255), ElementsAre(0, 0, 0, 128, 255, 255, 255, 255, 0, 0));
    EXPECT_THAT(levels_as(SampleFormat::linear16, 65535),
                ElementsAre(0, 0, 128, 32768, 65535, 65535, 65535, 65535, 0, 0));
}

TEST_F(PngFiles, ChunksAreThoseOfTheArgumentsOnly) {
    const Image image = levels(2, 2, 3, 255);
    const ImageMetadata metadata{"graftal 0.1", "graftal render 'ä b.rifs'", "a stamp"};
    ASSERT_EQ(write_png(path("a.png"), image, SampleFormat::srgb8, metadata), "");
    ASSERT_EQ(write_png(path("b.png"), image, SampleFormat::linear16, {}), "");
    const std::string a = bytes("a.png"), b = bytes("b.png");
    EXPECT_THAT(types_in(a),
                ElementsAre("IHDR", "gAMA", "sRGB", "cHRM", "tEXt", "tEXt", "tEXt", "IDAT", "IEND"));
    EXPECT_THAT(types_in(b), ElementsAre("IHDR", "gAMA", "IDAT", "IEND"));
    EXPECT_EQ(png_text(*png_chunks(a), "Software"), metadata.software);
    EXPECT_EQ(png_text(*png_chunks(a), "Description"), metadata.description);
    EXPECT_EQ(png_text(*png_chunks(a), stamp_keyword), metadata.stamp);
    EXPECT_EQ(png_chunks(a)->at(1).data, big_endian(45455)); // 100000 / 2.2
    EXPECT_EQ(png_chunks(b)->at(1).data, big_endian(100000));
}

TEST_F(PngFiles, LevelsAreNotCompressed) {
    const std::vector<std::uint16_t> values(3 * 64 * 64, 0x1234);
    ASSERT_EQ(write_png_levels(path("p.png"), 64, 64, values), "");
    EXPECT_THAT(read("p.png").pixels, testing::Each(static_cast<float>(0x1234) / 65535.0f));
    EXPECT_GT(bytes("p.png").size(), 2 * values.size());
}

TEST_F(PngFiles, EveryFailureToWriteIsTold) {
    for (const int width : {1, 300}) { // the second fills buffers before the file is closed
        const Image image = noise(width, width);
        const std::vector<std::uint16_t> values(image.pixels.size());
        EXPECT_EQ(write_png("/dev/full", image, SampleFormat::srgb8, {}), "No space left on device");
        EXPECT_EQ(write_png("/dev/full", image, SampleFormat::linear16, {}), "No space left on device");
        EXPECT_EQ(write_png_levels("/dev/full", width, width, values), "No space left on device");
    }
    EXPECT_EQ(write_png(path("none/a.png"), noise(1, 1), SampleFormat::srgb8, {}),
              "No such file or directory");
    EXPECT_THAT(write_png(path("a.png"), Image{0, 1, 3, {}}, SampleFormat::srgb8, {}), HasSubstr("IHDR"));
}

TEST_F(PngFiles, KindsOfOtherProgramsAreRead) {
    const float half = 128.0f / 255, third = 85.0f / 255;
    EXPECT_EQ(read_bytes(png_of({3, 1, 1, 0}, {"\0\xa0", 2})), (Image{3, 1, 1, {1, 0, 1}}));
    EXPECT_EQ(read_bytes(png_of({2, 1, 2, 0}, {"\0\x70", 2})), (Image{2, 1, 1, {third, 1}}));
    const std::string palette = png_chunk("PLTE", {"\xff\0\0\0\x80\0", 6});
    EXPECT_EQ(read_bytes(png_of({2, 1, 1, 3}, {"\0\x40", 2}, palette)),
              (Image{2, 1, 3, {1, 0, 0, 0, half, 0}}));
    EXPECT_EQ(read_bytes(png_of({2, 1, 1, 3}, {"\0\x40", 2}, palette + png_chunk("tRNS", "\x80"))),
              (Image{2, 1, 4, {1, 0, 0, half, 0, half, 0, 1}}));
    EXPECT_EQ(read_bytes(png_of({2, 1, 8, 0}, {"\0\x80\xff", 3}, png_chunk("tRNS", {"\0\x80", 2}))),
              (Image{2, 1, 2, {half, 0, 1, 1}}));
    EXPECT_EQ(read_bytes(png_of({1, 1, 16, 4}, {"\0\x80\0\x40\1", 5})),
              (Image{1, 1, 2, {32768.0f / 65535, 16385.0f / 65535}}));
    // As POV-Ray writes them: the gamma says how to show the values, and changes none.
    EXPECT_EQ(read_bytes(png_of({1, 1, 8, 2}, {"\0\x80\0\xff", 4}, png_chunk("gAMA", big_endian(100000)))),
              (Image{1, 1, 3, {half, 0, 1}}));
}

/// Three by one pixels in passes: of the first pixel, the third, the second.
TEST_F(PngFiles, InterlacedPixelsFindTheirPlaces) {
    const std::string passes("\0\xff\0\x80\0\x33", 6);
    EXPECT_EQ(read_bytes(png_of({3, 1, 8, 0, 1}, passes)), (Image{3, 1, 1, {1, 51.0f / 255, 128.0f / 255}}));
}

TEST_F(PngFiles, ShortenedOrDamagedFilesAreFailures) {
    ASSERT_EQ(write_png(path("a.png"), levels(9, 7, 3, 255), SampleFormat::srgb8, {"s", "d", "t"}), "");
    const std::string whole = bytes("a.png");
    const Image image = read("a.png");
    for (std::size_t length = png_signature.size(); length < whole.size(); ++length)
        EXPECT_EQ(error_of(whole.substr(0, length)), "it ends too early") << length;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        const bool beside_the_samples = error_of(damaged).empty();
        EXPECT_TRUE(!beside_the_samples || read("bytes.png") == image) << at;
    }
}

TEST_F(PngFiles, SizesBeyondTheLimitAreRefused) {
    const std::string row(4, '\0');
    EXPECT_EQ(error_of(png_of({900000, 900000, 8, 2}, row)), "it is too large");
    EXPECT_EQ(error_of(png_of({plenty / 1024, 1025, 8, 0}, row)), "it is too large");
    EXPECT_THAT(error_of(png_of({plenty / 1024, 1024, 8, 0}, row)), testing::Ne("it is too large"));
    for (const Header header :
         {Header{0, 1, 8, 2}, {1, 0, 8, 2}, {0xffffffff, 0xffffffff, 16, 6}, {1, 1, 3, 2}})
        EXPECT_NE(error_of(png_of(header, row)), "") << header.width;
}

TEST_F(PngFiles, AFileIsWhatItsBytesSay) {
    const Image image{1, 1, 3, {0, 1, 0}};
    ASSERT_TRUE(write_image(path("a.png"), image, SampleFormat::srgb8).ok());
    ASSERT_TRUE(write_image(path("b.exr"), image, SampleFormat::srgb8).ok());
    std::filesystem::rename(path("a.png"), path("a.exr"));
    std::filesystem::rename(path("b.exr"), path("b.png"));
    EXPECT_EQ(is_png_file(path("a.exr")), true);
    EXPECT_EQ(is_png_file(path("b.png")), false);
    for (const char* name : {"none.png", "."})
        EXPECT_EQ(is_png_file(path(name)), std::nullopt) << name;
    for (const char* name : {"a.exr", "b.png"}) {
        Image back;
        EXPECT_TRUE(read_image(path(name), back).ok()) << name;
        EXPECT_EQ(back, image) << name;
    }
}

/// It would take a quarter of a second.
TEST_F(PngFiles, NeedNoOpenImageIO) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto write_and_look = [&](const std::string& name) {
        Image image = noise(2, 2);
        const bool well =
            write_image(path(name), image, SampleFormat::srgb8).ok() && read_image(path(name), image).ok();
        std::ifstream file("/proc/self/maps");
        const std::string maps{std::istreambuf_iterator<char>(file), {}};
        std::_Exit(!well ? 2 : maps.find("libOpenImageIO") != std::string::npos ? 1 : 0);
    };
    EXPECT_EXIT(write_and_look("a.png"), testing::ExitedWithCode(0), "");
    EXPECT_EXIT(write_and_look("a.exr"), testing::ExitedWithCode(1), "");
}

} // namespace
} // namespace graftal
