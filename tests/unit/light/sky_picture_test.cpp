#include "compiler/light/sky_picture.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/light/longitude.h"
#include "compiler/support/counter_random.h"

namespace graftal {
namespace {

using Texel = SkyPicture::Texel;

/// Black, with some texels of white.
SkyPicture with_bright(int width, int height, std::vector<std::pair<int, int>> places, float light) {
    std::vector<Texel> texels(static_cast<std::size_t>(width * height), Texel{0, 0, 0});
    for (const auto& [x, y] : places)
        texels[static_cast<std::size_t>(y * width + x)] = {light, light, light};
    return {width, height, std::move(texels)};
}

SkyPicture noisy(int width, int height) {
    std::vector<Texel> texels;
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(width * height); ++i) {
        Texel texel;
        for (std::uint64_t c = 0; c < 3; ++c)
            texel[c] = static_cast<float>(CounterRandom::scrambled(3 * i + c) % 1000) / 250;
        texels.push_back(texel);
    }
    return {width, height, std::move(texels)};
}

Vec3 middle_of(int x, int y, int width, int height) {
    return direction_at((x + 0.5) / width, std::cos(std::numbers::pi * (y + 0.5) / height));
}

TEST(SkyPicture, ItsMiddleLiesTowardsXAndZIsToTheRight) {
    const SkyPicture picture(4, 2,
                             {{1, 0, 0},
                              {2, 0, 0},
                              {3, 0, 0},
                              {4, 0, 0}, //
                              {5, 0, 0},
                              {6, 0, 0},
                              {7, 0, 0},
                              {8, 0, 0}});
    const double r = std::sqrt(0.5); // of the middles of columns; those of rows are at 45 degrees
    const auto red = [&](double x, double y, double z) {
        return picture.radiance(glm::normalize(Vec3(x, y, z))).r;
    };
    EXPECT_NEAR(red(-r, 1, -r), 1, 1e-12);
    EXPECT_NEAR(red(r, 1, -r), 2, 1e-12);
    EXPECT_NEAR(red(r, 1, r), 3, 1e-12);
    EXPECT_NEAR(red(-r, 1, r), 4, 1e-12);
    EXPECT_NEAR(red(r, -1, r), 7, 1e-12);
    EXPECT_NEAR(red(1, 1, 0), 2.5, 1e-12) << "the middle";
    EXPECT_NEAR(red(-1, 1, 0), 2.5, 1e-12) << "across the seam";
    EXPECT_NEAR(red(1, 0, 0), 4.5, 1e-12) << "the horizon";
    EXPECT_NEAR(red(1e-9, 1, 1e-9), 3, 1e-6) << "the first row goes on to the pole";
}

TEST(SkyPicture, APlaceIsWhereItsDirectionIs) {
    for (const double u : {0.01, 0.25, 0.5, 0.7, 0.99})
        for (const double v : {0.01, 0.3, 0.5, 0.99}) {
            const glm::dvec2 place = place_of(3.0 * direction_at(u, std::cos(std::numbers::pi * v)));
            EXPECT_NEAR(place.x, u, 1e-12);
            EXPECT_NEAR(place.y, v, 1e-12);
        }
}

TEST(SkyPicture, AnEvenOneOfAnySizeLightsPaperByItsColour) {
    for (const auto& [width, height] : {std::pair(1, 1), {7, 5}, {64, 33}, {600, 300}, {2000, 3}}) {
        SCOPED_TRACE(testing::Message() << width << " x " << height);
        const SkyPicture picture(
            width, height, std::vector<Texel>(static_cast<std::size_t>(width * height), Texel{0.5f, 1, 4}));
        EXPECT_NEAR(picture.on_paper().r, 0.5, 1e-5);
        EXPECT_NEAR(picture.on_paper().b, 4, 4e-5);
        EXPECT_FALSE(picture.sampling().any());
    }
}

/// The mean of f over the directions of a long sequence.
template<typename F> double mean(const SkySampling& sampling, const F& f) {
    constexpr int count = 1 << 16;
    double sum = 0;
    for (int i = 0; i < count; ++i)
        sum += f(sampling.direction({(i + 0.5) / count, std::fmod(0.5 + i * 0.6180339887498949, 1.0)}));
    return sum / count;
}

TEST(SkySampling, ItsDensityIsThatOfItsDirections) {
    for (const auto& [width, height] : {std::pair(16, 9), {3, 1}, {1, 40}}) {
        SCOPED_TRACE(testing::Message() << width << " x " << height);
        const SkyPicture picture = noisy(width, height);
        const SkySampling& sampling = picture.sampling();
        ASSERT_TRUE(sampling.any());
        const auto integral = [&](const auto& f) {
            constexpr int n = 400;
            double sum = 0;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const double down = std::numbers::pi * (j + 0.5) / n;
                    const Vec3 direction = direction_at((i + 0.5) / n, std::cos(down));
                    const double size = 2 * std::numbers::pi * std::numbers::pi * std::sin(down) / n / n;
                    sum += f(direction) * sampling.density(direction) * size;
                }
            return sum;
        };
        const auto expect_equal = [&](const auto& f) { EXPECT_NEAR(mean(sampling, f), integral(f), 0.005); };
        EXPECT_NEAR(integral([](Vec3) { return 1.0; }), 1, 0.005);
        expect_equal([](Vec3 d) { return d.x; });
        expect_equal([](Vec3 d) { return d.y; });
        expect_equal([](Vec3 d) { return d.z; });
        expect_equal([](Vec3 d) { return d.x * d.z + 0.5 * d.y * d.y; });
        expect_equal([](Vec3 d) { return d.y > 0.9 ? 1.0 : 0.0; });
    }
}

TEST(SkySampling, FindsOneTexelAmongHundredThousands) {
    const SkyPicture picture = with_bright(512, 256, {{100, 70}}, 1e4f);
    const Vec3 sun = middle_of(100, 70, 512, 256);
    for (const double place : {0.0, 0.3, 0.5, 0.9999999})
        EXPECT_GT(glm::dot(picture.sampling().direction({place, place}), sun), 0.999);
    EXPECT_EQ(picture.sampling().density(-sun), 0);
}

TEST(SkyRegions, AddUpToTheLightAndOneBrightTexelIsOneOfThem) {
    const SkyPicture sunny = with_bright(400, 200, {{100, 30}}, 1e4f);
    const std::vector<SkyRegion> few = sky_regions(sunny.cells(), 40, true);
    Vec3 middle(0.0);
    double power = 0;
    for (const SkyRegion& region : few) {
        middle += region.power.g * region.direction;
        power += region.power.g;
    }
    const double size = 2 * std::numbers::pi / 400 *
                        (std::cos(std::numbers::pi * 30 / 200) - std::cos(std::numbers::pi * 31 / 200));
    EXPECT_NEAR(power, 1e4 * size, 0.001 * power);
    EXPECT_GT(glm::dot(glm::normalize(middle), middle_of(100, 30, 400, 200)), 0.99999);

    // The linear part of an irradiance is kept, however few they are.
    const SkyPicture picture = noisy(37, 21);
    for (const unsigned count : {1u, 16u, 1000u}) {
        double up = 0;
        const std::vector<SkyRegion> regions = sky_regions(picture.cells(), count, true);
        EXPECT_EQ(regions.size(), count);
        for (const SkyRegion& region : regions)
            up += region.power.r * region.direction.y;
        EXPECT_NEAR(up / std::numbers::pi, picture.on_paper().r, 0.02 * picture.on_paper().r) << count;
    }
}

TEST(SkyRegions, AreNoMoreThanTheLightHasCells) {
    EXPECT_TRUE(sky_regions(with_bright(8, 4, {}, 0).cells(), 40, false).empty());
    const SkyPicture picture = noisy(4, 2);
    EXPECT_LE(sky_regions(picture.cells(), 1u << 20, false).size(), 512u * 256);
    for (const SkyRegion& region : sky_regions(picture.cells(), 40, true))
        EXPECT_GT(region.direction.y, 0);
}

} // namespace
} // namespace graftal
