#include "compiler/scene/studio.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/scene/light_list.h"
#include "compiler/scene/scene.h"

namespace graftal {
namespace {

const Box cube{Vec3(-1), Vec3(1)};

Graph sphere() {
    Graph graph;
    graph.root = graph.primitive(PrimitiveKind::sphere);
    return graph;
}

View seen(const SceneSettings& settings, const Box& box = cube, const CameraOverride& camera = {}) {
    Graph graph = sphere();
    graph.settings = settings;
    return frame(graph, box, {160, 90}, camera);
}

/// What white paper shows that faces so, in full view of the light.
Rgb on_paper(const View& view, Vec3 normal) {
    Rgb sum(0.0);
    for (const Light& light : listed_lights(view, {64, 4000}))
        sum += std::max(0.0, glm::dot(normal, light.location)) * light.rgb;
    return sum;
}

TEST(Studio, ASolidThatNamesNoLightHasAWideSunOverTheLeftShoulderAndASky) {
    const View view = seen({});
    ASSERT_EQ(view.lights.size(), 1u);
    const Light& key = view.lights.front();
    EXPECT_TRUE(key.is_disc());
    EXPECT_LT(glm::dot(key.location, view.camera.right), 0);
    EXPECT_GT(glm::dot(key.location, view.camera.up), 0);
    EXPECT_LT(glm::dot(key.location, view.camera.direction), 0);
    EXPECT_TRUE(view.sky_light);
    EXPECT_FALSE(view.shows_sky_light);
    EXPECT_TRUE(view.film.soft);
}

TEST(Studio, LitSidesAreBrightAndShadedOnesAThirdOfThem) {
    const View view = seen({});
    const Vec3 key = view.lights.front().location;
    const double lit = on_paper(view, key).g, shaded = on_paper(view, -key).g;
    EXPECT_GT(lit, 1.2);
    EXPECT_LT(lit, 2);
    EXPECT_GT(shaded, 0.15 * lit);
    EXPECT_LT(shaded, 0.4 * lit);
}

TEST(Studio, ModelsThatNameALightOrASkyHaveNone) {
    SceneSettings lamp, sky;
    lamp.lights = {{.location = {1, 2, 3}, .sun = true}};
    sky.sky.emplace();
    EXPECT_FALSE(seen(lamp).sky_light);
    EXPECT_FALSE(seen(lamp).catcher);
    EXPECT_TRUE(seen(sky).lights.empty());
    EXPECT_FALSE(seen(sky).catcher);
}

TEST(Studio, FiguresHaveNone) {
    const View flat = seen({}, {{0, 0, 0}, {1, 1, 0}}), thin = seen({}, {{0, 0, 0}, {1, 1, 0.02}});
    for (const View& view : {flat, thin}) {
        EXPECT_FALSE(view.sky_light);
        EXPECT_FALSE(view.catcher);
        EXPECT_TRUE(view.film.plain());
    }
}

TEST(ShadowCatcher, WhereNothingStandsInTheLightItShowsTheBackground) {
    for (const CameraOverride& camera : {CameraOverride{}, CameraOverride{.up = Vec3(0.2, 1, 0)},
                                         CameraOverride{.location = Vec3(3, 4, 5), .orthographic = true}}) {
        const View view = seen({}, cube, camera);
        ASSERT_TRUE(view.catcher);
        const Vec3 centre = view.catcher->centre;
        EXPECT_EQ(centre, Vec3(0, -1, 0));
        const Vec3 sight =
            view.camera.orthographic ? view.camera.direction : glm::normalize(centre - view.camera.location);
        const Rgb shown = view.catcher->rgb * on_paper(view, {0, 1, 0});
        EXPECT_NEAR(glm::length(shown - view.background(sight)), 0, 0.01);
    }
}

TEST(ShadowCatcher, FadesFromItsCentreToItsRadius) {
    const ShadowCatcher catcher{.centre = {1, 2, 3}, .radius = 4};
    EXPECT_EQ(catcher.opacity({1, 2, 3}), 1);
    EXPECT_EQ(catcher.opacity({3, 2, 3}), 0.5625);
    EXPECT_EQ(catcher.opacity({1, 2, 7}), 0);
    EXPECT_EQ(catcher.opacity({1, 2, 70}), 0);
}

TEST(ShadowCatcher, NoneOverGroundAndWhereTheEyeIsInsideOrBelow) {
    SceneSettings ground;
    ground.ground.emplace();
    EXPECT_FALSE(seen(ground).catcher);
    EXPECT_TRUE(seen(ground).sky_light);
    EXPECT_FALSE(seen({}, cube, {.location = Vec3(0.2, 0.5, 0.1)}).catcher);
    EXPECT_FALSE(seen({}, cube, {.location = Vec3(1, -3, 5)}).catcher);
    EXPECT_FALSE(seen({}, cube, {.location = Vec3(0, -1, 5)}).catcher);
}

TEST(Studio, AirHidesWhereTheGroundEndsAndNotTheModel) {
    SceneSettings ground;
    ground.ground = GroundSetting{.height = -1};
    const View view = seen(ground);
    ASSERT_TRUE(view.haze);
    const Vec3 eye = view.camera.location;
    const double distance = glm::length(eye);
    EXPECT_GT(view.haze->left_after(eye, view.camera.direction, distance), 0.9);
    const Vec3 level = glm::normalize(Vec3(view.camera.direction.x, -1e-3, view.camera.direction.z));
    EXPECT_LT(view.haze->left_after(eye, level, 1000 * distance), 0.01);
    EXPECT_FALSE(seen({}).haze);
}

TEST(Haze, IsEvenWithoutAHeightHoweverThick) {
    SceneSettings thick;
    thick.haze = HazeSetting{.distance = 1e-9, .base = -5};
    const View view = seen(thick);
    ASSERT_TRUE(view.haze);
    EXPECT_NEAR(view.haze->left_after(Vec3(0, 1e6, 0), Vec3(0, 1, 0), 1e-9), std::exp(-1), 1e-12);
}

} // namespace
} // namespace graftal
