// Light from discs and from the sky, against closed forms and against long lists of lights.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/trace/lit_scene.h"

namespace graftal {
namespace {

/// A white ball in a white sky cannot be seen: each sample of each of its points is the sky's light.
TEST(SoftLight, AWhiteBallInAWhiteFurnaceVanishes) {
    View view = in_furnace({0.5, 0.25, 1});
    Scene scene;
    scene.balls.push_back({Vec3(0.0), 1, Rgb(1.0), matt});
    Shader shader(view, scene);
    for (const double x : {0.0, 0.3, 0.7, 0.99, 0.9999, 1.5}) {
        const Rgb light = mean_light(shader, {{x, 0, 10}, {0, 0, -1}}, 4);
        EXPECT_NEAR(light.r, 0.5, 1e-12) << x;
        EXPECT_NEAR(light.g, 0.25, 1e-12) << x;
        EXPECT_NEAR(light.b, 1, 1e-12) << x;
    }
}

/// Grey balls that light each other: with albedo a, what k bounces leave out is below a^(k + 1).
TEST(SoftLight, WhiteBallsThatTouchVanishAsTheBouncesGrow) {
    Scene scene;
    const Material nearly_white{.ambient = 0, .diffuse = 1, .specular = 0};
    for (const double x : {-1.0, 1.0})
        scene.balls.push_back({{x, 0, 0}, 1, Rgb(1.0), nearly_white});
    double before = 1;
    for (const unsigned bounces : {0u, 1u, 4u, 16u}) {
        View view = in_furnace(Rgb(1.0), bounces);
        Shader shader(view, scene);
        const double lost = 1 - mean_light(shader, {{0.3, 0, 10}, {0, 0, -1}}, 1 << 14).g;
        EXPECT_GT(lost, -0.003) << bounces; // noise
        EXPECT_LT(lost, 0.8 * before) << bounces;
        before = lost;
    }
    EXPECT_LT(before, 0.01);
}

/// One ray finds the other ball or the sky, and both send as much.
TEST(SoftLight, ABounceAndTheSkyAreOneEstimate) {
    Scene scene;
    for (const double x : {-1.0, 1.0})
        scene.balls.push_back({{x, 0, 0}, 1, Rgb(1.0), matt});
    const View view = in_furnace(Rgb(1.0), 16);
    Shader shader(view, scene);
    int noisy = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        SampleStream random(0, i);
        noisy += std::abs(shader.radiance({{0.1, 0, 10}, {0, 0, -1}}, random).g - 1) > 1e-9;
    }
    EXPECT_LT(noisy, 4096 / 20) << "only paths that are cut off at the last bounce";
}

TEST(SoftLight, GlossTakesItsOwnShareOfTheSkyWhereLightBounces) {
    Scene scene;
    Material glossy = matt;
    glossy.diffuse = 0.5;
    glossy.specular = 0.5;
    glossy.roughness = 0.5;
    scene.balls.push_back({{0, 0, 0}, 1, Rgb(0.6), glossy});
    const Ray ray{{0.4, 0.2, 10}, {0, 0, -1}};
    const auto light = [&](unsigned bounces) {
        const View view = in_furnace(Rgb(1.0), bounces);
        Shader shader(view, scene);
        return mean_light(shader, ray, 1 << 15).g;
    };
    EXPECT_GT(light(0), 0.35);
    EXPECT_NEAR(light(2), light(0), 0.004) << "a lone ball lights nothing else";
}

/// Of an even sky, a point that sees the part above a wall of height h at distance d with an endless edge.
TEST(SoftLight, AWallTakesHalfOfTheSky) {
    View view = in_furnace(Rgb(1.0));
    Scene scene;
    // The plane z = 0 faces the viewer; the plane x = 0.5 stands on it.
    scene.walls = {{{0, 0, 1}, 0, Rgb(1.0), matt}, {{1, 0, 0}, 0.5, Rgb(1.0), matt}};
    Shader shader(view, scene);
    const Rgb light = mean_light(shader, {{0, 0, 10}, {0, 0, -1}}, 4096);
    EXPECT_NEAR(light.g, 0.5, 0.005); // the cosine-weighted half x < 0
}

TEST(SoftLight, ADiscSunLightsLikeItsMiddleAndCastsAPenumbra) {
    View view = black_view();
    const double angle = std::numbers::pi / 6;
    view.lights = {
        {.location = {std::sin(angle), 0, std::cos(angle)}, .sun = true, .rgb = {1, 2, 3}, .angle_deg = 8}};
    Scene open;
    open.walls = {{{0, 0, 1}, 0, Rgb(1.0), matt}};
    Shader unshadowed(view, open);
    const Rgb light = mean_light(unshadowed, ahead, 1024);
    for (int c = 0; c < 3; ++c) // the mean cosine over a small disc is that of its middle, nearly
        EXPECT_NEAR(light[c], (c + 1) * std::cos(angle), 0.01 * (c + 1));

    // A ball of 4 degrees, seen in the middle of a sun of 8, covers a quarter of it.
    const double distance = 5, radius = distance * std::sin(2 * std::numbers::pi / 180);
    Scene eclipse = open;
    eclipse.balls.push_back({distance * view.lights[0].location, radius, Rgb(1.0), matt});
    Shader shadowed(view, eclipse);
    EXPECT_NEAR(mean_light(shadowed, ahead, 4096).r, 0.75 * std::cos(angle), 0.01);
}

/// A ball beside the ray takes the sun's share from a stretch of it.
TEST(SoftLight, HazeShowsTheSunBesideShadows) {
    View view = black_view();
    view.lights = {{.location = {1, 0, 0}, .sun = true, .rgb = Rgb(1.0)}};
    const double distance = 8, share = 0.75, radius = 2;
    view.haze = Haze{.rgb = {0.5, 0.25, 1}, .distance = distance, .height = INFINITY, .sun = share};
    const double aside = 0.64 / std::pow(1.36, 1.5);
    Scene open;
    Shader unshadowed(view, open);
    const Rgb whole = mean_light(unshadowed, ahead, 16);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(whole[c], (1 - share + share * aside) * view.haze->rgb[c], 1e-9);

    Scene shadowing;
    shadowing.balls.push_back({ahead(10) + Vec3(5, 0, 0), radius, Rgb(1.0), matt});
    Shader shadowed(view, shadowing);
    const double lost = std::exp(-(10 - radius) / distance) - std::exp(-(10 + radius) / distance);
    EXPECT_NEAR(mean_light(shadowed, ahead, 1 << 14).b, whole.b - share * aside * lost, 0.003);

    view.lights.front().shadowless = true;
    Shader shadowless(view, shadowing);
    EXPECT_NEAR(mean_light(shadowless, ahead, 16).b, whole.b, 1e-9);
    view.lights.clear();
    Shader without(view, shadowing);
    EXPECT_NEAR(mean_light(without, ahead, 16).b, 1, 1e-9) << "no sun: the haze's own light";
}

/// The estimate and the list have the same limit: all of a material, and a sky that is not even.
TEST(SoftLight, SamplesAndLongListsAgree) {
    View view = black_view();
    view.sky_light = SkyLight{.zenith = {0.3, 0.5, 0.9}, .horizon = {1, 0.9, 0.8}, .below = {0.3, 0.2, 0.1}};
    view.sky_light->up = glm::normalize(Vec3(0.3, 1, 0.4));
    view.lights = {
        {.location = glm::normalize(Vec3(1, 1, 1)), .sun = true, .rgb = Rgb(2.0), .angle_deg = 20}};
    const Material shining{.ambient = 0.1, .diffuse = 0.7, .specular = 0.3, .roughness = 0.1};
    Scene scene;
    scene.balls = {{Vec3(0.0), 1, {0.9, 0.5, 0.2}, shining}, {{0.7, 0.9, 0.8}, 0.5, Rgb(0.7), matt}};
    ShaderLimits listed;
    listed.list = LightListSize{50'000, 100'000};
    Shader by_list(view, scene, listed), by_samples(view, scene);
    EXPECT_FALSE(by_list.samples());
    EXPECT_TRUE(by_samples.samples());
    for (const Vec3 target : {Vec3(0.0), Vec3(0.5, 0.3, 0), Vec3(-0.6, 0.5, 0), Vec3(0.1, -0.9, 0)}) {
        const Vec3 eye(0, 0, 10);
        const Ray ray{eye, glm::normalize(target - eye)};
        const Rgb listed_light = by_list.radiance(ray), sampled = mean_light(by_samples, ray, 1 << 17);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sampled[c], listed_light[c], 0.0015) << target.x << " " << target.y;
    }
}

/// A half plane at y = 1 that shades the points below it, x < 0.
class Awning : public Scene {
  public:
    bool all_opaque() const override { return true; }
    bool meets_any(const Ray& ray, const RayRange& range) override {
        const double t = (1 - ray.origin.y) / ray.direction.y;
        return range.least < t && t < range.most && ray(t).x < 0;
    }
};

/// The ground sees, over the edge, the part of the lamp beyond a chord: at x the one at -x (height - 1).
TEST(SoftLight, ALampCastsThePenumbraOfItsShape) {
    constexpr double height = 100, half = 40;
    Awning scene;
    scene.walls = {{{0, 1, 0}, 0, Rgb(1.0), matt}};
    View view = black_view();
    for (const bool round : {false, true}) {
        view.lights = {{.location = {0, height, 0},
                        .rgb = Rgb(0.5),
                        .a = {half, 0, 0},
                        .b = {0, 0, round ? half : 1e-3},
                        .round = round}};
        Shader shader(view, scene);
        for (const double x : {-1.0, -0.3, -0.1, 0.0, 0.2, 0.35, 1.0}) {
            const double chord = std::clamp(x * (height - 1) / half, -1.0, 1.0);
            const double seen =
                round ? 1 - (std::acos(chord) - chord * std::sqrt(1 - chord * chord)) / std::numbers::pi
                      : 0.5 * (1 + chord);
            // Seen at an angle, what lies at its edge counts less: by the mean cosine of what is seen.
            double cosine = 0, weight = 0;
            for (int i = 0; i < 1000; ++i) {
                const double q = -1 + (i + 0.5) / 500;
                if (q < -chord) continue;
                const double width = round ? std::sqrt(1 - q * q) : 1;
                for (int j = 0; j < 50; ++j) {
                    const double z = round ? half * width * (-1 + (j + 0.5) / 25) : 0;
                    const double across = half * q - x;
                    cosine += width * height / std::sqrt(height * height + across * across + z * z) / 50;
                }
                weight += width;
            }
            const Ray down{{x, 0.5, 0}, {0, -1, 0}};
            EXPECT_NEAR(mean_light(shader, down, 1 << 13).g, 0.5 * seen * (weight > 0 ? cosine / weight : 0),
                        0.003)
                << (round ? "disc " : "rectangle ") << x;
        }
    }
}

TEST(SoftLight, AFarLampLightsLikeAPointOfItsColour) {
    Scene scene;
    scene.walls = {{{0, 0, 1}, 0, Rgb(1.0), matt}};
    View view = black_view();
    view.lights = {{.location = {3e3, 0, 4e3}, .rgb = {1, 2, 3}, .a = {0.8, 0, -0.6}, .b = {0, 1, 0}}};
    Shader shader(view, scene);
    EXPECT_TRUE(shader.samples());
    const Rgb light = mean_light(shader, ahead, 16);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light[c], 0.8 * (c + 1), 1e-3);
}

/// The same light from everywhere, whatever says so.
TEST(SoftLight, AnEvenPictureIsAFurnaceToo) {
    View view = in_furnace(Rgb(0.0));
    view.sky_light->picture = std::make_shared<SkyPicture>(
        6, 3, std::vector<SkyPicture::Texel>(18, SkyPicture::Texel{0.25f, 0.125f, 0.5f}));
    view.sky_light->brightness = 2;
    Scene scene;
    scene.balls.push_back({Vec3(0.0), 1, Rgb(1.0), matt});
    Shader shader(view, scene);
    for (const double x : {0.0, 0.7, 0.9999, 1.5}) {
        const Rgb light = mean_light(shader, {{x, 0, 10}, {0, 0, -1}}, 4);
        EXPECT_NEAR(light.r, 0.5, 1e-12) << x;
        EXPECT_NEAR(light.b, 1, 1e-12) << x;
    }
}

/// With the angle g between the normal and the middle of the white half, (1 + cos g) / 2.
TEST(SoftLight, AHalfWhitePictureLightsABallFromThatSide) {
    std::vector<SkyPicture::Texel> texels(2048 * 2, {0, 0, 0});
    for (std::size_t i = 0; i < texels.size(); ++i)
        if (i % 2048 >= 1024) texels[i] = {1, 1, 1}; // z > 0
    View view = in_furnace(Rgb(0.0));
    view.sky_light->picture = std::make_shared<SkyPicture>(2048, 2, std::move(texels));
    Scene scene;
    scene.balls.push_back({Vec3(0.0), 1, Rgb(1.0), matt});
    const double turned = std::numbers::pi / 3;
    for (const bool turn : {false, true}) {
        const Vec3 white = turn ? Vec3(std::sin(turned), 0, std::cos(turned)) : Vec3(0, 0, 1);
        if (turn) view.sky_light->picture_from_world = Affine::rotate({0, 1, 0}, -60).linear;
        Shader shader(view, scene);
        for (const Vec3 normal :
             {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(-0.6, 0.64, 0.48), Vec3(0, 0.8, 0.6)}) {
            const Rgb light = mean_light(shader, {normal + Vec3(0, 0, 9), {0, 0, -1}}, 1 << 14);
            EXPECT_NEAR(light.g, 0.5 * (1 + glm::dot(normal, white)), 0.004) << turn << normal.x;
        }
    }
}

/// One texel of a hundred thousand has most of the light: no sample of any pixel is far from its mean.
TEST(SoftLight, ASunInAPictureMakesNoSparks) {
    const int width = 512, height = 256;
    std::vector<SkyPicture::Texel> texels(static_cast<std::size_t>(width * height), {0.1f, 0.1f, 0.1f});
    texels[100 * 512 + 400] = {1e4f, 1e4f, 1e4f}; // z > 0, above
    View view = in_furnace(Rgb(0.0));
    view.sky_light->picture = std::make_shared<SkyPicture>(width, height, std::move(texels));
    const Material shining{.ambient = 0, .diffuse = 0.7, .specular = 0.3, .roughness = 0.1};
    Scene scene;
    scene.walls = {{{0, 0, 1}, 0, Rgb(1.0), shining}};
    scene.balls = {{{0.5, 0.2, 0.8}, 0.5, Rgb(0.7), matt}};
    ShaderLimits listed;
    listed.list = LightListSize{1, 100'000};
    Shader by_list(view, scene, listed), by_samples(view, scene);
    const double light = by_list.radiance(ahead).g;
    EXPECT_GT(light, 0.3) << "0.1 is the sky's";
    double sum = 0, squares = 0, largest = 0;
    constexpr int samples = 1 << 14;
    for (std::uint32_t i = 0; i < samples; ++i) {
        SampleStream random(0, i);
        const double sample = by_samples.radiance(ahead, random).g;
        sum += sample / samples;
        squares += (sample - light) * (sample - light) / samples;
        largest = std::max(largest, sample);
    }
    EXPECT_NEAR(sum, light, 0.01 * light);
    EXPECT_LT(std::sqrt(squares), 0.2 * light);
    EXPECT_LT(largest, 2 * light);
}

TEST(SoftLight, SamplesAndLongListsOfAPictureAgree) {
    View view = black_view();
    std::vector<SkyPicture::Texel> texels;
    for (int i = 0; i < 32 * 16; ++i) {
        const float light = i % 37 == 5 ? 20.0f : 0.2f + 0.05f * static_cast<float>(i % 11);
        texels.push_back({light, 0.7f * light, 0.1f + 0.01f * static_cast<float>(i % 7)});
    }
    view.sky_light.emplace();
    view.sky_light->picture = std::make_shared<SkyPicture>(32, 16, std::move(texels));
    view.sky_light->picture_from_world = Affine::rotate({0, 1, 0}, 50).linear;
    view.sky_light->brightness = 0.5;
    const Material shining{
        .ambient = 0.1, .diffuse = 0.7, .specular = 0.3, .roughness = 0.1, .translucency = 0.2};
    Scene scene;
    scene.balls = {{Vec3(0.0), 1, {0.9, 0.5, 0.2}, shining}, {{0.7, 0.9, 0.8}, 0.5, Rgb(0.7), matt}};
    ShaderLimits listed;
    listed.list = LightListSize{1, 100'000};
    Shader by_list(view, scene, listed), by_samples(view, scene);
    for (const Vec3 target : {Vec3(0.0), Vec3(0.5, 0.3, 0), Vec3(-0.6, 0.5, 0), Vec3(0.1, -0.9, 0)}) {
        const Vec3 eye(0, 0, 10);
        const Ray ray{eye, glm::normalize(target - eye)};
        const Rgb listed_light = by_list.radiance(ray), sampled = mean_light(by_samples, ray, 1 << 17);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sampled[c], listed_light[c], 0.004 * listed_light[c] + 0.001) << target.x << target.y;
    }
}

TEST(SoftLight, SamplesAndLongListsOfLampsAgree) {
    View view = black_view();
    view.lights = {
        {.location = {2, 3, 2}, .rgb = {1, 0.8, 0.6}, .a = {1, 0, -1}, .b = {0, 0.5, 0}},
        {.location = {-2, 1, 3}, .rgb = {0.3, 0.4, 0.8}, .a = {0.5, 0, 0}, .b = {0, 0.5, 0}, .round = true}};
    const Material shining{
        .ambient = 0.1, .diffuse = 0.7, .specular = 0.3, .roughness = 0.1, .translucency = 0.2};
    Scene scene;
    scene.balls = {{Vec3(0.0), 1, {0.9, 0.5, 0.2}, shining}, {{0.7, 0.9, 0.8}, 0.5, Rgb(0.7), matt}};
    ShaderLimits listed;
    listed.list = LightListSize{.area = 100'000};
    Shader by_list(view, scene, listed), by_samples(view, scene);
    EXPECT_FALSE(by_list.samples());
    for (const Vec3 target : {Vec3(0.0), Vec3(0.5, 0.3, 0), Vec3(-0.6, 0.5, 0), Vec3(0.1, -0.9, 0)}) {
        const Vec3 eye(0, 0, 10);
        const Ray ray{eye, glm::normalize(target - eye)};
        const Rgb listed_light = by_list.radiance(ray), sampled = mean_light(by_samples, ray, 1 << 15);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sampled[c], listed_light[c], 0.0015) << target.x << target.y;
    }
}

TEST(SoftLight, AmbientIsAShareOfTheSkysLightAndBouncesReplaceIt) {
    const Material glowing{.ambient = 0.25, .diffuse = 0, .specular = 0};
    Scene scene;
    scene.walls = {{{0, 0, 1}, 0, Rgb(1.0), glowing}};
    View view = in_furnace(Rgb(0.8));
    Shader shader(view, scene);
    EXPECT_NEAR(mean_light(shader, ahead, 4).g, 0.2, 1e-12);
    view.sky_light->bounces = 1;
    Shader bouncing(view, scene);
    EXPECT_EQ(mean_light(bouncing, ahead, 4).g, 0);
}

} // namespace
} // namespace graftal
