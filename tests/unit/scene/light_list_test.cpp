#include "compiler/scene/light_list.h"

#include <cmath>
#include <memory>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

/// What white paper that faces up shows.
Rgb on_paper(const std::vector<Light>& lights) {
    Rgb sum(0.0);
    for (const Light& light : lights)
        sum += std::max(0.0, light.location.y) * light.rgb;
    return sum;
}

TEST(LightList, ASkysLightsAddUpToItsLight) {
    View view;
    view.sky_light.emplace();
    view.sky_light->clear.emplace(3, glm::normalize(Vec3(1, 0.7, 2)), Vec3(0, 1, 0));
    view.sky_light->below = {0.3, 0.2, 0.1};
    const Rgb whole = view.sky_light->on_paper();
    double before = 1;
    for (const unsigned count : {40u, 400u, 4000u}) {
        const Rgb listed = on_paper(listed_lights(view, {1, count}));
        const double error = glm::length(listed - whole) / glm::length(whole);
        EXPECT_LT(error, before) << count;
        before = 0.3 * error + 1e-3;
    }
    EXPECT_LT(before, 4e-3);
}

TEST(LightList, NoneComesThroughAGround) {
    View view;
    view.sky_light = SkyLight{.zenith = Rgb(1.0), .horizon = Rgb(1.0), .below = Rgb(1.0)};
    int below = 0;
    for (const Light& light : listed_lights(view, {1, 50}))
        below += light.location.y < 0;
    EXPECT_EQ(below, 10);
    view.ground.emplace();
    const std::vector<Light> over_ground = listed_lights(view, {1, 50});
    EXPECT_EQ(over_ground.size(), 50u);
    for (const Light& light : over_ground)
        EXPECT_GT(light.location.y, 0);
}

TEST(LightList, ALampsPartsLieOnItsAreaAndAddUpToIt) {
    View view;
    const Vec3 middle(1, 5, 2), a(2, 0, 0), b(0, 0, 0.5);
    for (const bool round : {false, true}) {
        view.lights = {{.location = middle, .rgb = {2, 1, 0.5}, .a = a, .b = b, .round = round}};
        for (const unsigned count : {9u, 32u, 128u}) {
            const std::vector<Light> list = listed_lights(view, {.area = count});
            ASSERT_EQ(list.size(), count);
            Rgb sum(0.0);
            Vec3 mean(0.0);
            double squares = 0;
            for (const Light& light : list) {
                sum += light.rgb;
                const double x = (light.location.x - 1) / 2, z = (light.location.z - 2) / 0.5;
                EXPECT_LT(round ? x * x + z * z : std::max(x * x, z * z), 1);
                EXPECT_EQ(light.location.y, 5);
                mean += Vec3(x, 0, z) / static_cast<double>(count);
                squares += (x * x + z * z) / count;
                EXPECT_FALSE(light.is_area());
            }
            EXPECT_NEAR(glm::length(sum - Rgb(2, 1, 0.5)), 0, 1e-12);
            EXPECT_LT(glm::length(mean), 0.5 / std::sqrt(count));
            EXPECT_NEAR(squares, round ? 0.5 : 2.0 / 3, 0.06) << "as spread as the area";
        }
    }
}

TEST(LightList, AnEvenPicturesLightsAreThoseOfAnEvenSky) {
    View view;
    view.sky_light.emplace();
    view.sky_light->picture =
        std::make_shared<SkyPicture>(2, 1, std::vector<SkyPicture::Texel>(2, {0.25f, 0.5f, 1}));
    view.sky_light->brightness = 2;
    for (const unsigned count : {16u, 40u, 160u}) {
        const std::vector<Light> list = listed_lights(view, {1, count});
        EXPECT_EQ(list.size(), count);
        EXPECT_LT(glm::length(on_paper(list) - Rgb(0.5, 1, 2)), 1e-4) << "up, however few";
        Rgb aside(0.0);
        for (const Light& light : list)
            aside += std::max(0.0, light.location.x) * light.rgb;
        EXPECT_LT(glm::length(aside - Rgb(0.5, 1, 2)), 1.0 / count) << count;
    }
    view.ground.emplace();
    for (const Light& light : listed_lights(view, {1, 50}))
        EXPECT_GT(light.location.y, 0);
}

TEST(LightList, APictureTurnsWithItsSky) {
    View view;
    view.sky_light.emplace();
    std::vector<SkyPicture::Texel> texels(64 * 32, {0, 0, 0});
    texels[8 * 64 + 32] = {100, 100, 100}; // to the right of the middle, which is x
    view.sky_light->picture = std::make_shared<SkyPicture>(64, 32, std::move(texels));
    for (const double turn_deg : {0.0, 90.0, -30.0}) {
        view.sky_light->picture_from_world = Affine::rotate({0, 1, 0}, -turn_deg).linear;
        const Vec3 middle = Affine::rotate({0, 1, 0}, turn_deg)(Vec3(1, 0, 0));
        for (const Light& light : listed_lights(view, {1, 16})) {
            const Vec3 level = glm::normalize(Vec3(light.location.x, 0, light.location.z));
            EXPECT_GT(glm::dot(level, middle), 0.98) << turn_deg;
            EXPECT_GT(glm::dot(view.sky_light->radiance(light.location), Rgb(1.0)), 30) << turn_deg;
        }
    }
}

TEST(LightList, ASunsPartsLieOnItsDiscAndAddUpToIt) {
    View view;
    const Vec3 towards = glm::normalize(Vec3(1, 2, -0.5));
    view.lights = {{.location = towards, .sun = true, .rgb = {2, 1, 0.5}, .angle_deg = 10},
                   {.location = {1, 2, 3}, .rgb = Rgb(4.0)}};
    const std::vector<Light> list = listed_lights(view, {16, 1});
    ASSERT_EQ(list.size(), 17u);
    Rgb sum(0.0);
    Vec3 mean(0.0);
    double widest = 0;
    for (std::size_t i = 0; i < 16; ++i) {
        sum += list[i].rgb;
        mean += list[i].location / 16.0;
        widest = std::max(widest, std::acos(glm::dot(list[i].location, towards)));
    }
    EXPECT_NEAR(glm::length(sum - Rgb(2, 1, 0.5)), 0, 1e-12);
    EXPECT_LT(glm::length(glm::normalize(mean) - towards), 0.01);
    EXPECT_LT(widest, 5 * std::numbers::pi / 180);
    EXPECT_GT(widest, 4 * std::numbers::pi / 180);
    EXPECT_EQ(list.back().location, Vec3(1, 2, 3)) << "a lamp stays";
}

} // namespace
} // namespace graftal
