#include "runtime/image_files/texture_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "runtime/image_files/image_files.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

class TextureFiles : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }

    TemporaryDirectory directory_;
    TextureStore textures_;
};

/// Writes and commits.
template<typename... Arguments> Status save_texture(const std::string& path, const Arguments&... arguments) {
    PendingFile pending(path);
    const Status status = write_texture(pending, arguments...);
    return status.ok() ? pending.commit() : status;
}

/// Two by two, the texel at the top right clear.
Image picture() {
    return {2, 2, 4, {1, 0, 0, 1, /**/ 1, 1, 1, 0.4f, /**/ 0, 1, 0, 0.6f, /**/ 0, 0, 1, 1}};
}

TEST_F(TextureFiles, AreReadAsTexelsFromTheBottomLeftOn) {
    ASSERT_TRUE(write_image(path("a.png"), picture(), SampleFormat::srgb8).ok());
    Status status;
    const auto texture = textures_.load(path("a.png"), status);
    ASSERT_TRUE(texture) << status.message();
    using Level = std::array<std::uint8_t, 3>;
    EXPECT_EQ(texture->at(0.1, 0.1).srgb, (Level{0, 255, 0}));
    EXPECT_EQ(texture->at(0.9, 0.1).srgb, (Level{0, 0, 255}));
    EXPECT_EQ(texture->at(0.1, 0.9).srgb, (Level{255, 0, 0}));
    EXPECT_TRUE(texture->at(0.9, 0.9).clear);
    EXPECT_EQ(&texture->at(-0.9, 1.1), &texture->at(0.1, 0.1));
    EXPECT_EQ(&texture->at(1, -1), &texture->at(0, 0));
    EXPECT_EQ(&texture->at(-1e-300, 0), &texture->at(0.99, 0));
    EXPECT_EQ(texture->coverage, 0.75);
    EXPECT_NEAR(texture->mean.g, 1.0 / 3, 1e-12);
    EXPECT_EQ(textures_.load(path("a.png"), status), texture); // read once
}

TEST_F(TextureFiles, AreWrittenSoThatTheyReadTheSame) {
    ASSERT_TRUE(write_image(path("b.png"), picture(), SampleFormat::srgb8).ok());
    Status status;
    const auto texture = textures_.load(path("b.png"), status);
    ASSERT_TRUE(texture);
    ASSERT_TRUE(save_texture(path("c.png"), *texture).ok());
    const auto again = textures_.load(path("c.png"), status);
    ASSERT_TRUE(again);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(again->texels[i].srgb, texture->texels[i].srgb);
        EXPECT_EQ(again->texels[i].clear, texture->texels[i].clear);
    }
}

TEST_F(TextureFiles, WhatIsNoneIsSaid) {
    ASSERT_TRUE(write_text(path("d.png"), "no picture").ok());
    Status status;
    EXPECT_FALSE(textures_.load(path("d.png"), status));
    EXPECT_FALSE(status.ok());
    TextureFacts facts;
    EXPECT_FALSE(textures_.look_at(path("nowhere.png"), facts).ok());
}

/// White, the first column black.
TEST_F(TextureFiles, LargePicturesAreReducedAsTheyAreRead) {
    const int width = 8193, height = 8192;
    Image image{width, height, 2, {}};
    image.pixels.assign(2u * width * height, 1);
    for (int y = 0; y < height; ++y)
        image.pixels[2u * static_cast<std::size_t>(y) * width] = 0;
    ASSERT_TRUE(write_image(path("large.png"), image, SampleFormat::srgb8).ok());
    Status status;
    const auto texture = textures_.load(path("large.png"), status);
    ASSERT_TRUE(texture) << status.message();
    EXPECT_EQ(texture->file_width, width);
    EXPECT_EQ(texture->width, 4097);
    EXPECT_EQ(texture->height, 4096);
    EXPECT_EQ(texture->texels.size(), 4097u * 4096u);
    EXPECT_EQ(texture->at(0, 0.5).srgb[0], 188); // half the light
    EXPECT_EQ(texture->at(0.5, 0.5).srgb[0], 255);
    EXPECT_EQ(texture->coverage, 1);
    TextureFacts facts;
    ASSERT_TRUE(textures_.look_at(path("large.png"), facts).ok());
    EXPECT_EQ(facts.file_height, height);
    EXPECT_EQ(facts.height, 4096);
}

// Readers of GIF look at the first three letters of the stamp only.
TEST_F(TextureFiles, APictureOfManyPixelsInFewBytesIsRefusedWhateverItsVersion) {
    for (const std::string stamp : {"GIF89a", "GIF87a", "GIF99x"}) {
        ASSERT_TRUE(write_text(path("bomb.gif"), stamp + "\xff\xff\xff\xff" + std::string(13, '\0')).ok());
        Status status;
        EXPECT_FALSE(textures_.load(path("bomb.gif"), status));
        EXPECT_THAT(status.message(), testing::HasSubstr("too large")) << stamp;
    }
}

/// One part or many; an attribute of `bytes` that holds none.
std::string exr_head(bool many_parts, std::uint32_t bytes) {
    std::string head("\x76\x2f\x31\x01\x02\x00\x00\x00", 8);
    if (many_parts) head[5] = 0x10;
    head += std::string("note") + '\0' + "custom" + '\0';
    for (int shift = 0; shift < 32; shift += 8)
        head += static_cast<char>(bytes >> shift & 255);
    return head;
}

// OpenEXR makes room for an attribute before it reads it.
TEST_F(TextureFiles, AnAttributeLongerThanItsFileIsRefused) {
    for (const bool many_parts : {false, true})
        for (const std::uint32_t bytes : {1u, 0x70000000u, 0xffffffffu}) {
            ASSERT_TRUE(write_text(path("bomb.exr"), exr_head(many_parts, bytes)).ok());
            Status status;
            EXPECT_FALSE(textures_.load(path("bomb.exr"), status));
            EXPECT_THAT(status.message(), testing::HasSubstr("its head is damaged")) << bytes;
        }
}

TEST_F(TextureFiles, ALongAttributeOfATypeWithoutANameIsRefused) {
    const std::string head =
        exr_head(false, 0).substr(0, 8) + "note" + '\0' + '\0' + std::string("\0\0\0\x61", 4);
    ASSERT_TRUE(write_text(path("bomb.exr"), head + std::string(200, '\0')).ok());
    Status status;
    EXPECT_FALSE(textures_.load(path("bomb.exr"), status));
    EXPECT_THAT(status.message(), testing::HasSubstr("its head is damaged"));
}

// OpenEXR makes room for a tile before it looks at the picture.
TEST_F(TextureFiles, TilesMuchLargerThanTheirPictureAreRefused) {
    std::string text;
    ASSERT_TRUE(read_text(GRAFTAL_SOURCE_DIR "/tests/fuzz/corpus/picture/tiled.exr", text).ok());
    text.erase(0, 1); // it chooses an ending
    const std::size_t tiles = text.find("tiledesc");
    ASSERT_NE(tiles, std::string::npos);
    ASSERT_TRUE(write_text(path("tiled.exr"), text).ok());
    Status status;
    EXPECT_TRUE(textures_.load(path("tiled.exr"), status)) << status.message();
    text.replace(tiles + 13, 4, std::string("\x10\x00\xb5\x00", 4));
    ASSERT_TRUE(write_text(path("bomb.exr"), text).ok());
    EXPECT_FALSE(textures_.load(path("bomb.exr"), status));
    EXPECT_THAT(status.message(), testing::HasSubstr("its tiles are too large"));
}

// Of an attribute of a type that it knows, OpenEXR reads as much as the type says, whatever the length says.
TEST_F(TextureFiles, AnAttributeHiddenInAnotherIsRefused) {
    const std::string bomb = exr_head(false, 0x70000000).substr(8);
    const std::string box(16, 0), length{static_cast<char>(box.size() + bomb.size()), 0, 0, 0};
    const std::string head = exr_head(false, 0).substr(0, 8) + "dataWindow" + '\0' + "box2i" + '\0';
    ASSERT_TRUE(write_text(path("bomb.exr"), head + length + box + bomb).ok());
    Status status;
    EXPECT_FALSE(textures_.load(path("bomb.exr"), status));
    EXPECT_THAT(status.message(), testing::HasSubstr("its head is damaged"));
}

// OpenImageIO reads it, and crashes where it is damaged.
TEST_F(TextureFiles, ARareFormatIsRefused) {
    std::string sgi("\x01\xda\0\1\0\3\0\2\0\2\0\3\0\0\0\0\0\0\0\xff", 20);
    sgi.resize(512 + 2 * 2 * 3);
    ASSERT_TRUE(write_text(path("a.sgi"), sgi).ok());
    Status status;
    EXPECT_FALSE(textures_.load(path("a.sgi"), status));
    EXPECT_THAT(status.message(), testing::HasSubstr("format 'sgi'"));
}

TEST_F(TextureFiles, AreRegularFiles) {
    ASSERT_EQ(::mkfifo(path("pipe.png").c_str(), 0600), 0);
    for (const std::string& name : {path("pipe.png"), std::string("/dev/zero")}) {
        Status status;
        EXPECT_FALSE(textures_.load(name, status));
        EXPECT_THAT(status.message(), testing::HasSubstr("not a regular file"));
    }
}

TEST(Srgb, DecodingInvertsEncoding) {
    for (int level = 0; level < 256; ++level) {
        const auto linear = static_cast<float>(srgb_decoded(static_cast<std::uint8_t>(level)));
        EXPECT_NEAR(255 * srgb_encoded(linear), level, 1e-3);
    }
}

} // namespace
} // namespace graftal
