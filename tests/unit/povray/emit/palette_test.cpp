#include "compiler/povray/emit/palette.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace graftal {
namespace {

Palette ramp(std::uint32_t count) {
    Palette palette;
    for (std::uint32_t i = 0; i < count; ++i)
        palette.emplace_back(i / static_cast<double>(count), 0.5, 0.25);
    return palette;
}

TEST(PovrayPalette, UpTo128ColoursAreAMapOfHardSteps) {
    EXPECT_EQ(palette_pigment({Rgb(1, 0, 0), Rgb(0, 0.5, 1)}, "x.png"),
              "uv_mapping gradient x color_map {\n    [0 rgb <1,0,0>] [0.5 rgb <1,0,0>]\n"
              "    [0.5 rgb <0,0.5,1>] [1 rgb <0,0.5,1>] }");
    const std::string full = palette_pigment(ramp(128), "x.png");
    EXPECT_EQ(std::count(full.begin(), full.end(), '['), 256) << "POV-Ray takes no more than 256 entries";
    EXPECT_EQ(full.find("png"), std::string::npos);
    EXPECT_FALSE(PaletteLayout(128).picture());
    EXPECT_TRUE(PaletteLayout(129).picture());
}

TEST(PovrayPalette, PicturesAreClearInAllColours) {
    EXPECT_EQ(clear_image(""), "");
    EXPECT_EQ(clear_image("transmit 0.5"), "transmit all 0.5 ");
    EXPECT_EQ(clear_image("filter 0.25 transmit 0.25"), "filter all 0.25 transmit all 0.25 ");
}

TEST(PovrayPalette, StepsAreHitInTheirMiddle) {
    for (const std::uint32_t count : {2u, 3u, 100u, 128u})
        for (std::uint32_t slot = 0; slot < count; ++slot) {
            const auto [u, v] = PaletteLayout(count).uv(slot);
            EXPECT_NEAR(u * count - slot, 0.5, 1e-9);
            EXPECT_EQ(v, 0.5);
        }
}

TEST(PovrayPalette, PicturesAreHitInTheMiddleOfTheRightPixel) {
    for (const std::uint32_t count : {129u, 256u, 257u, 5000u, 100'000u}) {
        const Palette palette = ramp(count);
        const PaletteImage image = palette_image(palette, "x.png");
        const PaletteLayout layout(count);
        ASSERT_EQ(image.pixels.size(), count);
        ASSERT_LE(count, static_cast<std::size_t>(image.width) * image.height);
        ASSERT_LE(image.width, 4096);
        for (std::uint32_t slot = 0; slot < count; slot += 1 + count / 1000) {
            const auto [u, v] = layout.uv(slot);
            const double x = u * image.width, y = (1 - v) * image.height; // pixels from the top left
            ASSERT_NEAR(x - std::floor(x), 0.5, 1e-6);
            ASSERT_NEAR(y - std::floor(y), 0.5, 1e-6);
            const auto pixel = static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(x);
            ASSERT_EQ(image.pixels[pixel], palette[slot]) << slot;
        }
    }
    EXPECT_EQ(palette_pigment(ramp(129), "x.png"), "uv_mapping image_map { png \"x.png\" gamma 1.0 }");
}

TEST(PovrayPalette, MillionsOfColoursStayWithinPovraysPictures) {
    const PaletteLayout layout(40'000'000);
    EXPECT_EQ(layout.width(), 4096);
    EXPECT_EQ(layout.height(), 9766);
    EXPECT_GT(layout.uv(39'999'999).second, 0);
}

} // namespace
} // namespace graftal
