// Rough mirrors and rough glass, against the integral of the facets' formula.

#include "runtime/trace/shade/formulas.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/trace/lit_scene.h"

namespace graftal {
namespace {

using std::numbers::pi;

/// Of light that comes evenly from above, the share that facets of perfect mirrors send to a viewer at this
/// cosine: the integral of D(h) G1(v) G1(l) (v.h) / (v.n) over all normals h, with l = 2 (v.h) h - v.
double mirrored_share(double cosine, double blur) {
    const Vec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
    constexpr int rings = 2000, turns = 200;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        // Even in what the distribution has integrated: dense where facets are.
        const double u = (i + 0.5) / rings;
        const double z = std::sqrt((1 - u) / (1 + (blur * blur - 1) * u));
        for (int k = 0; k < turns; ++k) {
            const double turn = 2 * pi * (k + 0.5) / turns, r = std::sqrt(1 - z * z);
            const Vec3 h(r * std::cos(turn), r * std::sin(turn), z);
            const double along = glm::dot(v, h);
            if (!(along > 0)) continue;
            const Vec3 l = 2 * along * h - v;
            sum += formulas::unhidden(cosine, blur) * formulas::unhidden(l.z, blur) * along /
                   (cosine * z); // D z dh is even
        }
    }
    return sum / (rings * turns);
}

TEST(Facets, WhatTheyMirrorIsTheIntegralOfTheirFormula) {
    for (const double blur : {0.05, 0.3, 1.0})
        for (const double cosine : {1.0, 0.7, 0.2}) {
            const double expected = mirrored_share(cosine, blur);
            EXPECT_LE(expected, 1.0001);
            Scene scene;
            scene.walls.push_back(
                {{0, 0, 1},
                 0,
                 Rgb(1.0),
                 {.ambient = 0, .diffuse = 0, .specular = 0, .reflection = 1, .blur = blur}});
            const View view = in_furnace(Rgb(1.0));
            Shader shader(view, scene);
            const Ray ray{{0, 0, 10}, {std::sqrt(1 - cosine * cosine), 0, -cosine}};
            EXPECT_NEAR(mean_light(shader, ray, 1 << 14).r, expected, 0.004) << blur << " " << cosine;
        }
    EXPECT_LT(mirrored_share(1, 1), 0.8) << "facets that hide each other lose light";
}

TEST(Facets, LookWhereTheViewerSeesThem) {
    for (const double blur : {0.001, 0.2, 1.0})
        for (const Vec3 viewer : {Vec3(0, 0, 1), glm::normalize(Vec3(1, 2, 0.1)), Vec3(1, 0, 0)}) {
            SampleStream random(1, 0);
            for (int i = 0; i < 1000; ++i) {
                const Vec3 facet = formulas::visible_facet({0, 0, 1}, viewer, blur, random.next());
                EXPECT_NEAR(glm::length(facet), 1, 1e-12);
                EXPECT_GE(glm::dot(facet, viewer), -1e-12);
                EXPECT_GE(facet.z, 0);
            }
        }
}

TEST(Facets, AlmostSmoothOnesAreAMirrorOrAPane) {
    View view = black_view();
    view.sky_light = SkyLight{.zenith = Rgb(1.0, 0.2, 0), .horizon = Rgb(0, 0.4, 1), .below = Rgb(0.3)};
    view.shows_sky_light = true;
    Material sharp{.ambient = 0, .diffuse = 0, .specular = 0, .reflection = 1, .transparency = 1, .ior = 1.5};
    Material rough = sharp;
    rough.blur = 1e-3;
    const auto light = [&](const Material& material, double x) {
        Scene scene;
        scene.balls.push_back({{0, 0, 0}, 1, Rgb(1.0), material});
        Shader shader(view, scene);
        return mean_light(shader, {{x, 0.2, 10}, {0, 0, -1}}, 256);
    };
    for (const double x : {0.0, 0.3, 0.6, 0.8})
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(light(rough, x)[c], light(sharp, x)[c], 0.01) << x;
    rough.blur = 0.5;
    EXPECT_GT(glm::length(light(rough, 0.6) - light(sharp, 0.6)), 0.05);
    for (int c = 0; c < 3; ++c)
        EXPECT_LT(light(rough, 0.6)[c], 1.0);
}

TEST(Facets, OfAListOfLightsAreSharp) {
    View view = in_furnace(Rgb(0.5));
    view.sky_light->zenith = Rgb(1.0);
    const auto light = [&](double blur) {
        Scene scene;
        scene.balls.push_back(
            {{0, 0, 0}, 1, Rgb(1.0), {.ambient = 0.1, .diffuse = 0.5, .reflection = 0.5, .blur = blur}});
        Shader shader(view, scene, {.list = LightListSize{}});
        return shader.radiance({{0.4, 0.3, 10}, {0, 0, -1}});
    };
    EXPECT_EQ(light(0.4), light(0));
}

} // namespace
} // namespace graftal
