#include "compiler/light/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/light/blackbody.h"

namespace graftal {
namespace {

void expect_near(Rgb is, Rgb should, double error) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(is[c], should[c], error) << "channel " << c;
}

TEST(SkyLight, OneColourAllOverLightsPaperByIt) {
    SkyLight sky;
    sky.zenith = sky.horizon = sky.below = {0.2, 0.5, 3};
    expect_near(sky.on_paper(), {0.2, 0.5, 3}, 1e-12);
    expect_near(sky.radiance({0, -1, 0}), {0.2, 0.5, 3}, 1e-12);
}

TEST(SkyLight, AGradientIsThatOfTheHeight) {
    SkyLight sky;
    sky.zenith = Rgb(1.0);
    sky.horizon = Rgb(0.0);
    sky.below = Rgb(0.25);
    for (const double height : {0.0, 0.3, 0.6, 0.9, 1.0}) {
        const double level = std::sqrt(1 - height * height);
        expect_near(sky.radiance({level, height, 0}), Rgb(std::min(height / 0.6, 1.0)), 1e-12);
    }
    expect_near(sky.radiance({0.8, -0.6, 0}), Rgb(0.25), 0);
    // The integral of 2 h min(h / 0.6, 1) over h from 0 to 1.
    expect_near(sky.on_paper(), Rgb(2.0 / 3 * 0.36 + (1 - 0.36)), 1e-3);
}

TEST(SkyLight, ItsAverageIsThatOverAllDirections) {
    SkyLight sky;
    sky.zenith = Rgb(1.0);
    sky.horizon = Rgb(0.25);
    sky.below = Rgb(0.5);
    // Heights are spread evenly over a sphere: 0.6 of them are on the slope.
    EXPECT_NEAR(sky.average().r, 0.5 * (0.5 + 0.6 * 0.625 + 0.4), 1e-4);
    std::vector<SkyPicture::Texel> texels(64 * 32, SkyPicture::Texel{0, 0, 0});
    std::fill_n(texels.begin(), 64 * 16, SkyPicture::Texel{1, 2, 3});
    sky.picture = std::make_shared<const SkyPicture>(64, 32, texels);
    sky.brightness = 2;
    EXPECT_NEAR(sky.average().r, 1, 1e-6);
    EXPECT_NEAR(sky.average().b, 3, 1e-6);
}

TEST(SkyLight, AClearSkyIsFiniteAndBlueAndBrightestAboutTheSun) {
    for (const double turbidity : {2.0, 3.0, 6.0, 10.0})
        for (const double height_deg : {-30.0, 0.0, 1.0, 10.0, 45.0, 90.0}) {
            SCOPED_TRACE(testing::Message() << "turbidity " << turbidity << ", sun at " << height_deg);
            const double height = height_deg * std::numbers::pi / 180;
            SkyLight sky;
            sky.clear.emplace(turbidity, Vec3(std::cos(height), std::sin(height), 0), sky.up);
            const Vec3 to_sun = sky.clear->to_sun;
            EXPECT_NEAR(glm::length(to_sun), 1, 1e-12);
            for (int i = 0; i <= 20; ++i)
                for (int j = 0; j < 20; ++j) {
                    const double rise = i / 20.0, turn = 0.3 + j * std::numbers::pi / 10;
                    const double level = std::sqrt(1 - rise * rise);
                    const Rgb rgb = sky.radiance({level * std::cos(turn), rise, level * std::sin(turn)});
                    for (int c = 0; c < 3; ++c)
                        EXPECT_TRUE(std::isfinite(rgb[c]) && rgb[c] >= 0) << rise << " " << turn;
                }
            // At right angles to the sun the sky is blue.
            if (height_deg == 45 && turbidity < 6) {
                const Rgb away = sky.radiance(glm::normalize(Vec3(-to_sun.y, to_sun.x, 0.2)));
                EXPECT_GT(away.b, 1.2 * away.r);
                EXPECT_GT(sky.radiance(to_sun).g, away.g);
            }
        }
}

TEST(SkyLight, TheZenithOfAClearSkyIsTheFormulas) {
    // T = 3, the sun 45 degrees from the zenith: Yz = (4.0453 T - 4.9710) tan chi - 0.2155 T + 2.4192.
    const double chi = (4.0 / 9 - 3.0 / 120) * (std::numbers::pi - std::numbers::pi / 2);
    const double zenith_kcd = (4.0453 * 3 - 4.9710) * std::tan(chi) - 0.2155 * 3 + 2.4192;
    const ClearSky clear(3, glm::normalize(Vec3(1, 1, 0)), {0, 1, 0});
    const Rgb rgb = clear.radiance({0, 1, 0}, {0, 1, 0});
    EXPECT_NEAR(glm::dot(rgb, Rgb(0.2126729, 0.7151522, 0.0721750)), zenith_kcd, 1e-3 * zenith_kcd);
}

TEST(SkyLight, TurnedItShowsTheSame) {
    const Vec3 up = glm::normalize(Vec3(1, 2, -0.5)), to_sun = glm::normalize(Vec3(0.5, 1, 1));
    const ClearSky turned(4, to_sun, up);
    const double height = glm::dot(to_sun, up);
    const ClearSky upright(4, {std::sqrt(1 - height * height), height, 0}, {0, 1, 0});
    expect_near(turned.radiance(up, up), upright.radiance({0, 1, 0}, {0, 1, 0}), 1e-9);
    expect_near(turned.radiance(to_sun, up), upright.radiance(upright.to_sun, {0, 1, 0}), 1e-9);
}

TEST(Blackbody, IsWhiteAtNoonAndRedderWhenCooler) {
    const Rgb noon = blackbody_rgb(6504);
    EXPECT_NEAR(noon.r / noon.g, 1, 0.06);
    EXPECT_NEAR(noon.b / noon.g, 1, 0.06);
    double ratio = 0;
    for (double kelvin = least_temperature_k; kelvin <= most_temperature_k; kelvin *= 1.1) {
        const Rgb rgb = blackbody_rgb(kelvin);
        EXPECT_NEAR(glm::dot(rgb, Rgb(0.2126729, 0.7151522, 0.0721750)), 1, 0.05) << kelvin;
        EXPECT_GE(rgb.b / rgb.r, ratio) << kelvin;
        ratio = rgb.b / rgb.r;
    }
    EXPECT_EQ(blackbody_rgb(1000).b, 0) << "outside of the gamut";
}

} // namespace
} // namespace graftal
