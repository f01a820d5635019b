// Metal, clear coats and glass, against closed forms.

#include "runtime/trace/shade/formulas.h"
#include "runtime/trace/shade/optics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/trace/lit_scene.h"

namespace graftal {
namespace {

/// Counts the rays that look for the first surface.
class CountingScene : public Scene {
  public:
    int rays = 0;
    bool closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) override {
        ++rays;
        return Scene::closest(ray, range, hit);
    }
};

constexpr double places[] = {0.0, 0.3, 0.7, 0.9, 0.99, 0.9999};

Ray at(double x) {
    return {{x, 0, 10}, {0, 0, -1}};
}

const Material clear_glass{
    .ambient = 0, .diffuse = 0, .specular = 0, .reflection = 1, .transparency = 1, .ior = 1.5};
const Material lamp{.ambient = 0, .diffuse = 0, .specular = 0, .emission = 1};

TEST(Optics, FresnelsFormulaHasItsKnownValues) {
    for (const double ior : {1.1, 1.33, 1.5, 2.4, 10.0}) {
        const double straight = (ior - 1) / (ior + 1);
        EXPECT_NEAR(formulas::fresnel(ior, 1), straight * straight, 1e-15);
        EXPECT_NEAR(formulas::fresnel(1 / ior, 1), straight * straight, 1e-15);
        EXPECT_EQ(formulas::fresnel(ior, 0), 1);
        // At Brewster's angle only light that swings across is reflected, half of it.
        const double across = (ior * ior - 1) / (ior * ior + 1);
        EXPECT_NEAR(formulas::fresnel(ior, 1 / std::sqrt(1 + ior * ior)), 0.5 * across * across, 1e-14);
        // From inside, all beyond the critical angle, and what a ray meets there and back is the same.
        const double critical = std::sqrt(1 - 1 / (ior * ior));
        EXPECT_EQ(formulas::fresnel(1 / ior, 0.999 * critical), 1);
        const double inside = 0.5 * (1 + critical);
        const double outside = std::sqrt(1 - ior * ior * (1 - inside * inside));
        EXPECT_NEAR(formulas::fresnel(1 / ior, inside), formulas::fresnel(ior, outside), 1e-13);
    }
    EXPECT_EQ(formulas::fresnel(1, 0.5), 0);
}

TEST(Optics, MetalKeepsItsColourExceptAtGrazingAngles) {
    const Rgb gold(1, 0.7, 0.3);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(formulas::metal_colour(1, gold, 1)[c], gold[c], 1e-6);
        EXPECT_NEAR(formulas::metal_colour(1, gold, 0)[c], 1, 0.01);
        EXPECT_EQ(formulas::metal_colour(0, gold, 0.5)[c], 1);
        EXPECT_NEAR(formulas::metal_colour(0.5, gold, 1)[c], 0.5 + 0.5 * gold[c], 1e-6);
    }
}

TEST(Optics, RaysKnowTheSolidsThatTheyAreIn) {
    const Interior water{1.3, Rgb(0.5)}, glass{1.5, Rgb(0.0, 1.0, 0.0)};
    Inside inside;
    EXPECT_EQ(inside.relative_ior(glass), 1.5);
    EXPECT_DOUBLE_EQ(inside.cross(water), 1 / 1.3);
    EXPECT_DOUBLE_EQ(inside.relative_ior(glass), 1.5 / 1.3);
    EXPECT_DOUBLE_EQ(inside.relative_ior(water), 1 / 1.3);
    EXPECT_DOUBLE_EQ(inside.cross(glass), 1.3 / 1.5);
    EXPECT_NEAR(inside.left_after(2).g, std::exp(-3), 1e-15);
    EXPECT_EQ(inside.cross(water), 1) << "the rest counts as glass since it began";
    EXPECT_DOUBLE_EQ(inside.cross(glass), 1.5);
    EXPECT_EQ(inside.left_after(1e9), Rgb(1.0));
    for (int i = 0; i < 100; ++i) // more than it can know
        inside.cross({1.1 + i, Rgb(0.0)});
    EXPECT_EQ(inside.cross({50, Rgb(0.0)}), 1);
}

/// What the coat does not mirror the white below it scatters: nothing is lost or won.
TEST(Optics, ACoatedWhiteBallInAFurnaceVanishes) {
    for (const unsigned bounces : {0u, 3u}) {
        const View view = in_furnace({0.5, 0.25, 1}, bounces);
        Scene scene;
        scene.balls.push_back({Vec3(0.0),
                               1,
                               Rgb(1.0),
                               {.ambient = 0, .diffuse = 1, .specular = 0, .reflection = 1, .ior = 1.5}});
        Shader shader(view, scene);
        for (const double x : places) {
            const Rgb light = mean_light(shader, at(x), 1 << 10);
            const double error = bounces == 0 ? 2.0 / 255 : 0.02; // rays that are too faint; noise
            EXPECT_NEAR(light.r / 0.5, 1, error) << x;
            EXPECT_NEAR(light.b, 1, error) << x;
            if (bounces == 0) {
                EXPECT_LT(light.b, 1 + 1e-12);
            }
        }
    }
}

TEST(Optics, AGlassBallInAFurnaceVanishes) {
    const View view = in_furnace(Rgb(1.0));
    CountingScene scene;
    scene.balls.push_back({Vec3(0.0), 1, Rgb(1.0), clear_glass});
    Shader coarse(view, scene), fine(view, scene, {.least_weight = 1e-6});
    for (const double x : places) {
        scene.rays = 0;
        const double light = coarse.radiance(at(x)).g;
        EXPECT_LT(scene.rays, 255);
        EXPECT_LT(light, 1 + 1e-12);
        // Near its edge light goes round in it more often than it is followed.
        EXPECT_GT(light, x < 0.999 ? 0.97 : 0.94);
        EXPECT_NEAR(fine.radiance(at(x)).g, 1, x < 0.999 ? 1e-3 : 0.01) << x;
    }
}

/// Each ray parts in two at each of the surfaces, which are as many as it may meet.
TEST(Optics, RaysThatPartStayFew) {
    const View view = in_furnace(Rgb(1.0));
    CountingScene scene;
    Material half = clear_glass;
    half.ior = 10;
    for (int i = 0; i < 60; ++i)
        scene.walls.push_back({{0, 0, 1}, -0.1 * i, Rgb(1.0), half});
    Shader shader(view, scene, {.least_weight = 1e-3});
    EXPECT_LT(shader.radiance(ahead).g, 1 + 1e-12);
    EXPECT_LT(scene.rays, 32 * 1000);
    EXPECT_GT(scene.rays, 32);
}

TEST(Optics, LightFadesInASlabByBeersLaw) {
    const Rgb colour(0.3, 0.6, 0.9);
    const double thickness = 3, distance = 2;
    for (const double ior : {1.0, 1.5})
        for (const double angle : {0.0, 20.0, 60.0}) {
            Material slab = clear_glass;
            slab.rgb = colour;
            slab.reflection = 0;
            slab.ior = ior;
            slab.absorption = distance;
            View view = black_view();
            Scene scene;
            scene.walls = {{{0, 0, 1}, 0, colour, slab},
                           {{0, 0, 1}, -thickness, colour, slab},
                           {{0, 0, 1}, -10, Rgb(1.0), lamp}};
            const double sine = std::sin(angle * std::numbers::pi / 180);
            const Rgb light =
                Shader(view, scene).radiance({{0, 0, 10}, {sine, 0, -std::sqrt(1 - sine * sine)}});
            const double way = thickness / std::sqrt(1 - sine * sine / (ior * ior)); // Snell's law
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(light[c], std::pow(colour[c], way / distance), 1e-5) << ior << " " << angle;
        }
}

TEST(Optics, ShadowsOfGlassAreColoured) {
    View view = black_view();
    view.lights = {{.location = {0, 0, 1}, .sun = true}};
    const Rgb colour(0.3, 0.6, 0.9);
    Material pane = clear_glass;
    pane.transparency = 0.5;
    Scene scene;
    scene.walls = {{{0, 0, 1}, 0, Rgb(1.0), matt}};
    scene.balls = {{{0, 0, 5}, 1, colour, pane}};
    const Ray past{{3, 0, 10}, glm::normalize(Vec3(-3, 0, -10))};
    for (int c = 0; c < 3; ++c) // in and out
        EXPECT_NEAR(Shader(view, scene).radiance(past)[c], 0.25 * colour[c] * colour[c], 1e-12);
    scene.balls[0].material.absorption = 4;
    scene.balls[0].material.rgb = colour;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(Shader(view, scene).radiance(past)[c], 0.25 * std::sqrt(colour[c]), 1e-12);
}

TEST(Optics, MetalColoursHighlights) {
    View view = black_view();
    view.lights = {{.location = {0, 0, 1}, .sun = true}};
    Scene scene;
    scene.walls = {
        {{0, 0, 1}, 0, {1, 0.7, 0.3}, {.ambient = 0, .diffuse = 0, .specular = 0.5, .metallic = 1}}};
    const Rgb light = Shader(view, scene).radiance(ahead);
    EXPECT_NEAR(light.r, 0.5, 1e-6);
    EXPECT_NEAR(light.g, 0.35, 1e-6);
    EXPECT_NEAR(light.b, 0.15, 1e-6);
}

/// As in SoftLight.SamplesAndLongListsAgree.
TEST(Optics, SamplesAndLongListsAgreeOnGlassAndMetal) {
    View view = black_view();
    view.sky_light = SkyLight{.zenith = {0.3, 0.5, 0.9}, .horizon = {1, 0.9, 0.8}, .below = {0.3, 0.2, 0.1}};
    view.shows_sky_light = true;
    view.lights = {
        {.location = glm::normalize(Vec3(1, 1, 1)), .sun = true, .rgb = Rgb(2.0), .angle_deg = 20}};
    const Material gold{
        .ambient = 0.1, .diffuse = 0.2, .specular = 0.6, .roughness = 0.1, .reflection = 0.5, .metallic = 1};
    const Material jade{.diffuse = 0.6,
                        .specular = 0.4,
                        .roughness = 0.2,
                        .reflection = 1,
                        .transparency = 0.5,
                        .ior = 1.4,
                        .absorption = 1};
    Scene scene;
    scene.balls = {{Vec3(0.0), 1, {0.9, 0.6, 0.2}, gold}, {{0.9, 0.9, 1.2}, 0.6, {0.4, 0.8, 0.5}, jade}};
    ShaderLimits listed;
    listed.list = LightListSize{20'000, 50'000};
    Shader by_list(view, scene, listed), by_samples(view, scene);
    for (const Vec3 target : {Vec3(0.0), Vec3(0.3, 0.3, 0), Vec3(-0.6, 0.5, 0), Vec3(0.8, 0.8, 1.2)}) {
        const Vec3 eye(0, 0, 10);
        const Ray ray{eye, glm::normalize(target - eye)};
        const Rgb listed_light = by_list.radiance(ray), sampled = mean_light(by_samples, ray, 1 << 16);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sampled[c], listed_light[c], 0.004) << target.x << " " << target.y;
    }
}

} // namespace
} // namespace graftal
