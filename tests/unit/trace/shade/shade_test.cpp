#include "runtime/trace/shade/shade.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/trace/lit_scene.h"

namespace graftal {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

void expect_rgb(Rgb is, Rgb should, double error = 1e-14) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(is[c], should[c], error) << "channel " << c;
}

/// A wall through the origin that the viewer sees along its normal.
struct FacingWall {
    View view = black_view();
    Scene scene;

    explicit FacingWall(const Material& material, Rgb rgb = Rgb(1.0)) {
        scene.walls.push_back({{0, 0, 1}, 0, rgb, material});
    }
    Rgb look(const Ray& ray = ahead) { return Shader(view, scene).radiance(ray); }
};

Light sun_at(double angle_deg, Rgb rgb = Rgb(1.0)) {
    const double angle = angle_deg * std::numbers::pi / 180;
    return {.location = {std::sin(angle), 0, std::cos(angle)}, .sun = true, .rgb = rgb};
}

TEST(Shader, AmbientLightNeedsNoLamp) {
    FacingWall wall({.ambient = 0.25, .diffuse = 1}, {0.8, 0.4, 0});
    expect_rgb(wall.look(), {0.2, 0.1, 0});
}

TEST(Shader, DiffuseLightGoesWithTheCosine) {
    for (const double angle : {0.0, 30.0, 60.0, 89.0, 90.0, 91.0, 120.0, 180.0}) {
        SCOPED_TRACE(angle);
        FacingWall wall({.ambient = 0, .diffuse = 0.5, .specular = 0}, {0.8, 0.4, 1});
        wall.view.lights = {sun_at(angle, {1, 2, 0.5})};
        const double cosine = std::max(0.0, std::cos(angle * std::numbers::pi / 180));
        expect_rgb(wall.look(), 0.5 * cosine * Rgb(0.8, 0.8, 0.5));
    }
}

TEST(Shader, SurfacesHaveTwoSides) {
    FacingWall wall(matt);
    wall.view.lights = {sun_at(60)};
    expect_rgb(wall.look({{0, 0, 10}, {0, 0, -1}}), Rgb(0.5));
    expect_rgb(wall.look({{0, 0, -10}, {0, 0, 1}}), Rgb(0.0));
    wall.scene.walls[0].normal.z = -1;
    expect_rgb(wall.look({{0, 0, 10}, {0, 0, -1}}), Rgb(0.5));
}

TEST(Shader, LampsDoNotFadeWithTheDistance) {
    for (const double distance : {0.5, 3.0, 1e6}) {
        FacingWall wall(matt);
        wall.view.lights = {{.location = {0, 0, distance}}};
        expect_rgb(wall.look(), Rgb(1.0));
        wall.view.lights = {{.location = {distance, 0, distance}}};
        expect_rgb(wall.look(), Rgb(std::sqrt(0.5)));
    }
}

TEST(Shader, LampsAddUp) {
    FacingWall wall(matt);
    wall.view.lights = {sun_at(0, {1, 0, 0}), {.location = {0, 0, 1}, .rgb = {0, 0.5, 3}}, sun_at(60)};
    expect_rgb(wall.look(), {1.5, 1, 3.5});
}

TEST(Shader, HighlightsAreOfTheLightsColour) {
    for (const double roughness : {1.0, 0.05, 0.001, 1e-4, 0.0}) {
        SCOPED_TRACE(roughness);
        FacingWall wall({.ambient = 0, .diffuse = 0, .specular = 0.5, .roughness = roughness}, Rgb(0.0));
        const double exponent = 1 / std::max(roughness, 5e-4);
        for (const double angle : {0.0, 1.0, 20.0, 80.0}) {
            wall.view.lights = {sun_at(angle, {1, 0.5, 2})};
            // Halfway to the viewer, at 0.
            const double glint = std::pow(std::cos(angle * std::numbers::pi / 360), exponent);
            expect_rgb(wall.look(), 0.5 * glint * Rgb(1, 0.5, 2), 1e-12);
        }
        wall.view.lights = {sun_at(95)};
        expect_rgb(wall.look(), Rgb(0.0));
    }
}

TEST(Shader, ShadowlessLampsMakeNeitherShadowsNorHighlights) {
    FacingWall wall({.ambient = 0, .diffuse = 1, .specular = 1}, Rgb(0.5));
    wall.scene.balls.push_back({{0, 0, 5}, 1, Rgb(1.0), matt});
    wall.view.lights = {sun_at(0)};
    const Ray past{{3, 0, 10}, glm::normalize(Vec3(-3, 0, -10))};
    expect_rgb(wall.look(past), Rgb(0.0));
    wall.view.lights[0].shadowless = true;
    expect_rgb(wall.look(past), Rgb(0.5));
}

TEST(Shader, ShadowsEndAtALamp) {
    FacingWall wall(matt);
    wall.view.lights = {{.location = {0, 0, 3}}};
    wall.scene.balls.push_back({{0, 0, 5}, 1, Rgb(1.0), matt});
    const Ray past{{3, 0, 10}, glm::normalize(Vec3(-3, 0, -10))};
    expect_rgb(wall.look(past), Rgb(1.0));
    wall.view.lights[0].location.z = 7;
    expect_rgb(wall.look(past), Rgb(0.0));
    wall.view.lights[0].location.z = 5; // inside
    expect_rgb(wall.look(past), Rgb(0.0));
}

TEST(Shader, LooksForShadowsOnlyWhereLightWouldCome) {
    FacingWall wall(matt);
    wall.view.lights = {sun_at(120), sun_at(10, Rgb(0.0)), sun_at(0), sun_at(20)};
    wall.view.lights[2].shadowless = true;
    wall.look();
    EXPECT_EQ(wall.scene.shadow_rays, 1);
    wall.scene.walls[0].rgb = Rgb(0.0);
    wall.look();
    EXPECT_EQ(wall.scene.shadow_rays, 1);
}

TEST(Shader, SurfacesDoNotShadowThemselves) {
    View view = black_view();
    view.size = {1000, 1000};
    for (const double scale : {1e-6, 1.0, 1e6}) {
        Scene scene;
        scene.balls.push_back({Vec3(0.3, 0.2, 0) * scale, scale, Rgb(1.0), matt});
        view.camera.location = Vec3(0, 0, 10) * scale;
        const Vec3 towards = glm::normalize(Vec3(1, 1, 0.2));
        view.lights = {{.location = towards, .sun = true}};
        Shader shader(view, scene);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 at(0.3 + 0.9 * std::sin(i) * i / 1000, 0.2 + 0.9 * std::cos(i) * i / 1000, 0);
            const Ray ray{view.camera.location, glm::normalize(at * scale - view.camera.location)};
            SurfaceHit hit;
            ASSERT_TRUE(shader.first_hit(ray, hit));
            const double cosine = glm::dot(hit.normal, towards);
            if (std::abs(cosine) > 1e-6) expect_rgb(shader.radiance(ray), Rgb(std::max(0.0, cosine)));
        }
    }
}

TEST(Shader, MirrorsAddWhatTheyShow) {
    FacingWall wall({.ambient = 0.1, .diffuse = 0, .reflection = 0.5});
    wall.view.sky.zenith = wall.view.sky.horizon = {0.2, 0.4, 4};
    expect_rgb(wall.look(), {0.2, 0.3, 2.1});
    wall.scene.balls.push_back({{8, 0, 8}, 1, {1, 0, 0}, {.ambient = 1, .diffuse = 0}});
    const double half = std::sqrt(0.5);
    expect_rgb(wall.look({{-8, 0, 8}, {half, 0, -half}}), {0.6, 0.1, 0.1});
}

TEST(Shader, FacingMirrorsShow32Surfaces) {
    const Material mirror{.ambient = 1, .diffuse = 0, .reflection = 1};
    FacingWall wall(mirror, {1, 0, 0});
    wall.scene.walls.push_back({{0, 0, 1}, 20, {0, 1, 0}, mirror});
    expect_rgb(wall.look(), {16, 16, 0});
}

TEST(Shader, FaintReflectionsAreLeftOut) {
    const Material mirror{.ambient = 1, .diffuse = 0, .reflection = 0.1};
    FacingWall wall(mirror, {1, 0, 0});
    wall.scene.walls.push_back({{0, 0, 1}, 20, {0, 1, 0}, mirror});
    // 0.01 is more than 1/255, 0.001 is less.
    expect_rgb(wall.look(), {1.01, 0.1, 0});
    Shader fine(wall.view, wall.scene, {.least_weight = 0.9e-5});
    expect_rgb(fine.radiance(ahead), {1.0101, 0.10101, 0});
}

TEST(Shader, TheGroundIsLitAndThrowsShadows) {
    View view = black_view();
    view.ground = Ground{-1, {.rgb = {0.5, 0.25, 1}, .ambient = 0.1, .diffuse = 1, .specular = 0}};
    view.lights = {{.location = {0, 0.6, 0.8}, .sun = true}};
    Scene scene;
    scene.balls.push_back({{0, 2, 0}, 1, Rgb(1.0), matt});
    Shader shader(view, scene);
    const Ray down{{5, 3, 0}, {0, -1, 0}};
    SurfaceHit hit;
    ASSERT_TRUE(shader.first_hit(down, hit));
    EXPECT_EQ(hit.t, 4);
    EXPECT_EQ(hit.rgb, Rgb(0.5, 0.25, 1));
    EXPECT_EQ(hit.material, &view.ground->material);
    expect_rgb(shader.radiance(down), 0.7 * Rgb(0.5, 0.25, 1));
    // Of the ball, and under the ground.
    expect_rgb(shader.radiance({{0, 0, -4}, {0, -1, 0}}), 0.1 * Rgb(0.5, 0.25, 1));
    expect_rgb(shader.radiance({{5, -3, 0}, {0, 1, 0}}), 0.1 * Rgb(0.5, 0.25, 1));
    scene.balls[0].centre.y = -4;
    expect_rgb(shader.radiance({{0, -1.5, 0}, {0, -1, 0}}), Rgb(0.0));
    view.ground->height = -100;
    expect_rgb(shader.radiance({{0, -1.5, 0}, {0, -1, 0}}), Rgb(0.6));
}

TEST(Shader, TheNearerOfGroundAndModelIsSeen) {
    View view = black_view();
    view.ground = Ground{};
    Scene scene;
    scene.balls.push_back({{0, 0, 0}, 1, Rgb(1.0), matt});
    Shader shader(view, scene);
    SurfaceHit hit;
    ASSERT_TRUE(shader.first_hit({{0, 5, 0}, {0, -1, 0}}, hit));
    EXPECT_EQ(hit.t, 4);
    ASSERT_TRUE(shader.first_hit({{2, 5, 0}, {0, -1, 0}}, hit));
    EXPECT_EQ(hit.t, 5);
    ASSERT_TRUE(shader.first_hit({{2, -5, 0}, {0, 1, 0}}, hit));
    EXPECT_EQ(hit.t, 5);
    EXPECT_FALSE(shader.first_hit({{2, 5, 0}, {0, 1, 0}}, hit));
    EXPECT_FALSE(shader.first_hit({{2, 5, 0}, {1, 0, 0}}, hit));
}

TEST(Shader, NothingIsSeenBeyondTheFarthest) {
    View view = black_view();
    view.ground = Ground{};
    view.sky.zenith = view.sky.horizon = Rgb(0.7);
    Scene scene;
    SurfaceHit hit;
    Shader near_sighted(view, scene, {.farthest = 4.5});
    EXPECT_TRUE(near_sighted.first_hit({{0, 4, 0}, {0, -1, 0}}, hit));
    EXPECT_FALSE(near_sighted.first_hit({{0, 5, 0}, {0, -1, 0}}, hit));
    expect_rgb(near_sighted.radiance({{0, 5, 0}, {0, -1, 0}}), Rgb(0.7));
}

TEST(Shader, TheSkyRunsFromHorizonToZenith) {
    View view = black_view();
    view.sky = {.zenith = {0, 0, 1}, .horizon = {1, 0.5, 0}, .axis = {0, 1, 0}, .from = -0.5, .to = 0.5};
    Scene scene;
    Shader shader(view, scene);
    struct {
        double height, zenith;
    } const cases[] = {{-1, 0},      {-0.5, 0},       {-0.25, 0.25}, {0, 0.5},
                       {0.25, 0.75}, {0.5, 0.999999}, {1, 0.999999}};
    for (const auto& c : cases) {
        const Vec3 direction(std::sqrt(1 - c.height * c.height), c.height, 0);
        expect_rgb(shader.radiance({{0, 0, 0}, direction}),
                   (1 - c.zenith) * view.sky.horizon + c.zenith * view.sky.zenith);
    }
    view.sky.horizon = view.sky.zenith;
    expect_rgb(Shader(view, scene).radiance(ahead), {0, 0, 1}, 0);
}

TEST(Shader, SeesFromInsideASolid) {
    View view = black_view();
    view.lights = {{.location = {0, 0, 0.5}}};
    Scene scene;
    scene.balls.push_back({{0, 0, 0}, 1, Rgb(1.0), matt});
    expect_rgb(Shader(view, scene).radiance({{0, 0, 0}, {0, 0, -1}}), Rgb(1.0));
    view.lights[0].location.z = 1.5; // outside
    expect_rgb(Shader(view, scene).radiance({{0, 0, 0}, {0, 0, -1}}), Rgb(0.0));
}

/// Gives one answer to all questions.
class Oracle : public Surfaces {
  public:
    SurfaceHit answer;
    bool closest(const Ray&, const RayRange&, SurfaceHit& hit) override {
        hit = answer;
        return true;
    }
    bool meets_any(const Ray&, const RayRange&) override { return false; }
};

TEST(Shader, GivesNumbersForDegenerateInput) {
    const Material shiny{.specular = 1, .reflection = 1};
    const Vec3 vectors[] = {Vec3(0.0), {0, 0, -1},  {0, 0, 1},   Vec3(not_a_number),
                            Vec3(inf), Vec3(1e200), Vec3(1e-200)};
    View view = black_view();
    view.ground = Ground{0, shiny};
    view.sky = {.zenith = Rgb(1.0), .horizon = Rgb(0.5), .from = 0.3, .to = 0.3};
    Oracle oracle;
    Scene nothing;
    for (const Vec3& a : vectors)
        for (const Vec3& b : vectors)
            for (const double t : {0.0, 10.0, 1e300, inf, not_a_number})
                for (const bool orthographic : {false, true}) {
                    oracle.answer = {t, a, Rgb(1.0), &shiny};
                    view.camera.orthographic = orthographic;
                    view.lights = {{.location = b, .sun = true}, {.location = b}, {.location = Vec3(0.0)}};
                    for (Surfaces* surfaces :
                         {static_cast<Surfaces*>(&oracle), static_cast<Surfaces*>(&nothing)})
                        for (const Vec3& origin : {Vec3(0.0), view.camera.location, b}) {
                            const Rgb rgb = Shader(view, *surfaces).radiance({origin, b});
                            EXPECT_TRUE(std::isfinite(rgb.x + rgb.y + rgb.z));
                        }
                }
}

TEST(Shader, ALampOnTheSurfaceLightsNothingThere) {
    FacingWall wall({.ambient = 0.5, .diffuse = 1, .specular = 1});
    wall.view.lights = {{.location = {0, 0, 0}}};
    expect_rgb(wall.look(), Rgb(0.5));
}

} // namespace
} // namespace graftal
