#include "runtime/image_files/sky_file.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/texture_store.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

class SkyFiles : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }

    LoadedSkyPicture load(const std::string& name, const Image& image) {
        EXPECT_TRUE(write_image(path(name), image, SampleFormat::srgb8).ok());
        LoadedSkyPicture loaded;
        const Status status = textures_.load_sky(path(name), loaded);
        EXPECT_TRUE(status.ok()) << status.message();
        return loaded;
    }

    TemporaryDirectory directory_;
    TextureStore textures_;
};

TEST_F(SkyFiles, ExrIsLinearAndPngIsSrgb) {
    const Image image{2, 1, 3, {0.5f, 0.25f, 1, 0.5f, 0.25f, 1}};
    EXPECT_EQ(load("a.exr", image).picture->radiance({1, 0, 0}), Rgb(0.5, 0.25, 1));
    const Rgb decoded = load("a.png", image).picture->radiance({1, 0, 0});
    EXPECT_NEAR(decoded.r, 0.2159, 1e-4); // of the level 128
    EXPECT_EQ(decoded.b, 1);
    EXPECT_EQ(load("grey.exr", {2, 1, 1, {3, 3}}).picture->radiance({0, 1, 0}), Rgb(3.0));
}

TEST_F(SkyFiles, WhatIsNoLightIsMendedAndCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    const LoadedSkyPicture loaded = load(
        "bad.exr", {4, 2, 3, {nan,       1,     1, /**/ 1, -2, 1, /**/ 1, 1, infinity, /**/ 1, 1, 1e20f, //
                              -infinity, -0.0f, 0, /**/ 1, 1,  1, /**/ 1, 1, 1e6f,     /**/ 0, 0, 0}});
    EXPECT_EQ(loaded.mended, 5u);
    const SkyPicture& picture = *loaded.picture;
    EXPECT_EQ(picture.radiance_at(0.125, 0.25), Rgb(0, 1, 1));
    EXPECT_EQ(picture.radiance_at(0.375, 0.25), Rgb(1, 0, 1));
    EXPECT_EQ(picture.radiance_at(0.625, 0.25), Rgb(1, 1, most_radiance));
    EXPECT_EQ(picture.radiance_at(0.125, 0.75), Rgb(0.0));
    EXPECT_TRUE(std::isfinite(picture.on_paper().b));
    EXPECT_TRUE(picture.sampling().any());
}

TEST_F(SkyFiles, LargePicturesAreReducedAsTheyAreRead) {
    const int width = 9000, height = 3;
    Image image{width, height, 1, std::vector<float>(static_cast<std::size_t>(width * height), 1)};
    for (std::size_t x = 0; x < 9000; x += 3)
        image.pixels[x] = image.pixels[9000 + x] = image.pixels[18000 + x] = 4;
    const LoadedSkyPicture loaded = load("wide.exr", image);
    EXPECT_EQ(loaded.file_width, width);
    EXPECT_EQ(loaded.picture->width(), 3000);
    EXPECT_EQ(loaded.picture->height(), 1);
    EXPECT_NEAR(loaded.picture->radiance({0, 1, 0}).g, 2, 1e-6);
    LoadedSkyPicture small;
    ASSERT_TRUE(read_sky_picture(path("wide.exr"), 100, small).ok());
    EXPECT_LE(small.picture->width() * small.picture->height(), 100);
}

TEST_F(SkyFiles, AreReadOnceUntilTheyChange) {
    const LoadedSkyPicture first = load("a.exr", {1, 1, 3, {1, 2, 3}});
    LoadedSkyPicture again;
    ASSERT_TRUE(textures_.load_sky(path("a.exr"), again).ok());
    EXPECT_EQ(first.picture, again.picture);
    EXPECT_FALSE(textures_.forget_changed());
    ASSERT_TRUE(write_image(path("a.exr"), {2, 1, 3, {4, 5, 6, 4, 5, 6}}, SampleFormat::srgb8).ok());
    EXPECT_TRUE(textures_.forget_changed());
    ASSERT_TRUE(textures_.load_sky(path("a.exr"), again).ok());
    EXPECT_EQ(again.picture->radiance({0, 1, 0}), Rgb(4, 5, 6));
}

TEST_F(SkyFiles, WhatIsNoneIsSaid) {
    ASSERT_TRUE(write_text(path("a.hdr"), "no picture").ok());
    LoadedSkyPicture loaded;
    EXPECT_FALSE(textures_.load_sky(path("a.hdr"), loaded).ok());
    EXPECT_FALSE(textures_.load_sky(path("nowhere.exr"), loaded).ok());
    EXPECT_FALSE(loaded.picture);
}

TEST_F(SkyFiles, AreWrittenWithTheSameLight) {
    const SkyPicture picture(4, 2,
                             {{1, 0, 0},
                              {2, 0, 1e5f},
                              {3, 0, 0},
                              {4, 0, 0}, //
                              {5, 1, 0},
                              {6, 1, 0},
                              {7, 1, 0},
                              {8, 1, 0}});
    PendingFile pending(path("out.exr"));
    ASSERT_TRUE(write_sky_picture(pending, picture, 2).ok());
    ASSERT_TRUE(pending.commit().ok());
    LoadedSkyPicture loaded;
    ASSERT_TRUE(read_sky_picture(path("out.exr"), 1 << 20, loaded).ok());
    EXPECT_EQ(loaded.picture->width(), 4);
    EXPECT_GE(loaded.picture->height(), 512);
    for (const double u : {0.1, 0.4, 0.5, 0.77})
        for (const double v : {0.26, 0.5, 0.6, 0.9}) {
            const Rgb is = loaded.picture->radiance_at(u, v), should = 2.0 * picture.radiance_at(u, v);
            EXPECT_NEAR(is.r, should.r, 1e-5);
            EXPECT_NEAR(is.g, should.g, 1e-5);
        }
    EXPECT_EQ(loaded.picture->radiance_at(0.375, 0.2).b, 65504) << "what half floats hold";
}

} // namespace
} // namespace graftal
