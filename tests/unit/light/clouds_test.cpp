#include "compiler/light/clouds.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/light/longitude.h"

namespace graftal {
namespace {

const Vec3 to_sun = glm::normalize(Vec3(1, 1, 0.3));

SkyLight blue_sky() {
    SkyLight sky;
    sky.zenith = {0.1, 0.2, 0.6};
    sky.horizon = {0.5, 0.6, 0.8};
    sky.below = {0.2, 0.1, 0.05};
    return sky;
}

Clouds clouds_of(double cover) {
    return {.cover = cover, .to_sun = to_sun, .sun_rgb = Rgb(1.5)};
}

/// Looks at evenly spread directions that are higher than `least`.
template<typename Look> void over_sky(double least, const Look& look) {
    constexpr int rings = 60, parts = 240;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < parts; ++j)
            look(direction_at((j + 0.5) / parts, least + (1 - least) * (i + 0.5) / rings));
}

TEST(Clouds, TheyCoverTheShareThatIsAsked) {
    const SkyLight sky = blue_sky();
    double before = -1;
    for (const double cover : {0.2, 0.5, 1.0}) {
        const auto picture = cloudy_picture(sky, clouds_of(cover));
        double covered = 0, all = 0;
        // Of the layer, and not of the sky: a direction stands for as much of it as it is away, and aslant.
        over_sky(0.3, [&](Vec3 direction) {
            const double area = 1 / (direction.y * direction.y * direction.y);
            all += area;
            if (glm::length(picture->radiance(direction) - sky.radiance(direction)) > 0.05) covered += area;
        });
        EXPECT_NEAR(covered / all, cover, 0.15) << cover;
        EXPECT_GT(covered / all, before) << cover;
        before = covered / all;
    }
}

TEST(Clouds, WithoutCoverTheSkyIsAsItWas) {
    const SkyLight sky = blue_sky();
    const auto picture = cloudy_picture(sky, clouds_of(0));
    over_sky(0.05, [&](Vec3 direction) {
        EXPECT_LT(glm::length(picture->radiance(direction) - sky.radiance(direction)), 0.01) << direction.y;
    });
}

TEST(Clouds, BelowTheHorizonNothingChanges) {
    const SkyLight sky = blue_sky();
    const auto picture = cloudy_picture(sky, clouds_of(0.7));
    over_sky(0.02, [&](Vec3 direction) {
        EXPECT_LT(glm::length(picture->radiance(-direction) - sky.below), 1e-6);
    });
}

TEST(Clouds, LightIsFiniteUnderEverySun) {
    const auto is_finite = [](double turbidity, Vec3 sun, double cover) {
        SkyLight sky = blue_sky();
        if (turbidity > 0) sky.clear.emplace(turbidity, sun, sky.up);
        const auto picture =
            cloudy_picture(sky, {.cover = cover, .turn_deg = 1e4, .to_sun = sun, .sun_rgb = Rgb(3)});
        bool finite = true;
        over_sky(0, [&](Vec3 direction) {
            const Rgb light = picture->radiance(direction);
            for (int c = 0; c < 3; ++c)
                finite = finite && light[c] >= 0 && light[c] < 100;
        });
        return finite;
    };
    EXPECT_TRUE(is_finite(2, {0, 1, 0}, 0.3));
    EXPECT_TRUE(is_finite(10, {1, 0, 0}, 1));
    EXPECT_TRUE(is_finite(3, {0, -1, 0}, 0.5)) << "straight below";
    EXPECT_TRUE(is_finite(0, glm::normalize(Vec3(1, 0.05, 1)), 0.6));
}

/// What a step of half a texel changes is no more across the seam of the picture than elsewhere.
TEST(Clouds, NoSeamShows) {
    const auto picture = cloudy_picture(blue_sky(), clouds_of(0.5));
    const auto roughness = [&](double u) {
        double sum = 0;
        for (int row = 0; row < 400; ++row) {
            const double y = 0.1 + 0.85 * row / 400;
            const double step = 0.5 / picture->width();
            sum += glm::length(picture->radiance(direction_at(u + step, y)) -
                               picture->radiance(direction_at(u - step, y)));
        }
        return sum;
    };
    double most = 0;
    for (int i = 1; i < 40; ++i)
        most = std::max(most, roughness(i / 40.0));
    EXPECT_LT(roughness(0), 1.5 * most);
}

TEST(Clouds, TheSameAreTheSame) {
    const auto first = cloudy_picture(blue_sky(), clouds_of(0.4));
    Clouds turned = clouds_of(0.4);
    turned.turn_deg = 30;
    const auto other = cloudy_picture(blue_sky(), turned);
    const auto again = cloudy_picture(blue_sky(), clouds_of(0.4));
    int apart = 0;
    over_sky(0.1, [&](Vec3 direction) {
        EXPECT_EQ(first->radiance(direction), again->radiance(direction));
        apart += glm::length(first->radiance(direction) - other->radiance(direction)) > 0.1;
    });
    EXPECT_GT(apart, 1000) << "another turn";
}

TEST(Clouds, AnOwnerDrawsAPictureOnceWhileItIsInUse) {
    CloudPictures pictures, others;
    auto first = pictures.picture(blue_sky(), clouds_of(0.4));
    EXPECT_EQ(pictures.picture(blue_sky(), clouds_of(0.4)), first);
    EXPECT_NE(others.picture(blue_sky(), clouds_of(0.4)), first) << "two owners share nothing";
    const std::weak_ptr<const SkyPicture> unused = first;
    first.reset();
    EXPECT_TRUE(unused.expired()) << "the owner keeps no memory";
}

TEST(Clouds, AFlagEndsTheDrawingOfAPicture) {
    CloudPictures pictures;
    int asked = 0;
    {
        const CloudPictures::Drawing drawing(pictures, 128, CancelFlag([&] { return ++asked > 5; }));
        EXPECT_THROW(pictures.picture(blue_sky(), clouds_of(0.4)), Cancelled);
        EXPECT_EQ(asked, 6) << "once a row";
    }
    EXPECT_TRUE(pictures.picture(blue_sky(), clouds_of(0.4))) << "nobody asks a flag that is gone";
}

TEST(Clouds, LittleWorkMakesASmallSky) {
    EXPECT_EQ(cloud_rows(15), most_cloud_rows);
    EXPECT_EQ(cloud_rows(5), most_cloud_rows / 2);
    EXPECT_EQ(cloud_rows(2), most_cloud_rows / 4);
    EXPECT_EQ(cloud_rows(0.01), 128);
    CloudPictures pictures;
    const auto whole = pictures.picture(blue_sky(), clouds_of(0.4));
    const CloudPictures::Drawing drawing(pictures, 128, {});
    const auto small = pictures.picture(blue_sky(), clouds_of(0.4));
    EXPECT_EQ(small->width(), 256);
    EXPECT_EQ(pictures.picture(blue_sky(), clouds_of(0.4)), small);
    // It is the same sky.
    Rgb sum(0.0);
    int looks = 0;
    over_sky(0.1, [&](Vec3 direction) {
        sum += glm::abs(whole->radiance(direction) - small->radiance(direction));
        ++looks;
    });
    EXPECT_LT(glm::length(sum / static_cast<double>(looks)), 0.1);
}

} // namespace
} // namespace graftal
