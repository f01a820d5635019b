#include "compiler/povray/emit/view.h"

#include <cmath>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/povray/scene_by_hand.h"

namespace graftal {
namespace {

using namespace by_hand;
using testing::HasSubstr;
using testing::Not;

TEST(PovrayView, CameraIsGivenByItsAxesAndNotMirrored) {
    Scene scene = one_sphere();
    const std::string text =
        scene.text(frame(scene.graph, scene.cut.bounds, {400, 300}, {.location = Vec3(0, 0, 9)}));
    EXPECT_THAT(text, Not(HasSubstr("look_at")));
    EXPECT_EQ(vector_after(text, "location"), Vec3(0, 0, 4500));
    EXPECT_GT(vector_after(text, "right").x, 1.33);
    EXPECT_EQ(vector_after(text, "up"), Vec3(0, 1, 0));
    EXPECT_LT(vector_after(text, "direction").z, 0);
}

TEST(PovrayView, AngleOfViewIsHorizontal) {
    Scene scene = one_sphere();
    const std::string text = scene.text(
        frame(scene.graph, scene.cut.bounds, {300, 600}, {.location = Vec3(0, 0, 9), .angle_deg = 90}));
    EXPECT_DOUBLE_EQ(vector_after(text, "right").x, 0.5);
    EXPECT_DOUBLE_EQ(vector_after(text, "direction").z, -0.25);
}

TEST(PovrayView, ParallelViewsHaveTheirWidthAndHeight) {
    Scene scene = one_sphere();
    const std::string text = scene.text(frame(scene.graph, scene.cut.bounds, {400, 200}, {.width = 3}));
    EXPECT_THAT(text, HasSubstr("orthographic"));
    EXPECT_NEAR(vector_after(text, "up").y / 750, scene.view().camera.up.y, 1e-9);
}

TEST(PovrayView, LightsSkyAndGroundFollowTheView) {
    Scene scene = one_sphere();
    View view = scene.view();
    view.lights = {{.location = {0, 1, 0}, .sun = true, .rgb = {0.5, 0.25, 1}, .shadowless = true},
                   {.location = {1, 2, 3}}};
    view.sky = {.zenith = Rgb(0.1), .horizon = Rgb(0.1)};
    view.ground = Ground{.height = -0.5, .material = {.rgb = {0, 1, 0}}};
    std::string text = scene.text(view);
    EXPECT_THAT(
        text,
        HasSubstr("light_source { <0,1000000,0> rgb <0.5,0.25,1> parallel point_at <0,0,0> shadowless }"));
    EXPECT_THAT(text, HasSubstr("light_source { <500,1000,1500> rgb <1,1,1> }"));
    EXPECT_THAT(text, HasSubstr("background { rgb <0.1,0.1,0.1> }"));
    EXPECT_THAT(text, HasSubstr("plane { y, -250\n  texture { pigment { rgb <0,1,0> }"));
    EXPECT_THAT(text, Not(HasSubstr("max_trace_level")));
    view.sky.horizon = Rgb(0.9);
    view.ground->material.reflection = 0.5;
    text = scene.text(view);
    EXPECT_THAT(text, HasSubstr("sky_sphere"));
    EXPECT_THAT(text, HasSubstr("reflection 0.5"));
    EXPECT_THAT(text, HasSubstr("max_trace_level 32"));
}

TEST(PovrayView, WorldIsBroughtToAboutAThousandUnits) {
    for (const double size : {1e-12, 1e-5, 0.3, 1.0, 7.0, 1e9})
        for (const double away : {0.0, 100.0}) {
            Scene scene = one_sphere();
            const Vec3 centre(away * size, 0, 0);
            scene.cut.groups[0].placements[0].world_from_body = place(centre, Vec3(size));
            scene.cut.bounds = {centre - Vec3(size), centre + Vec3(size)};
            const std::string text = scene.text();
            const Vec3 at = vector_after(text, "sphere {");
            EXPECT_LE(std::abs(at.x), 1e-6) << size << " " << away;
            const double radius =
                std::strtod(text.c_str() + text.find(">, ", text.find("sphere { <")) + 3, nullptr);
            EXPECT_GE(radius, 200) << size;
            EXPECT_LE(radius, 500.1) << size;
        }
}

TEST(PovrayView, FarCamerasStayWithinPovraysReach) {
    Scene scene = one_sphere();
    const std::string text =
        scene.text(frame(scene.graph, scene.cut.bounds, {400, 300}, {.location = Vec3(0, 0, 1e6)}));
    EXPECT_LE(vector_after(text, "location").z, 5e6);
}

TEST(PovrayView, EmptyCutsAndPointsAreScenesToo) {
    Scene nothing;
    nothing.cut.bounds = {};
    EXPECT_THAT(nothing.text(frame(nothing.graph, {Vec3(0), Vec3(1)}, {10, 10})), HasSubstr("camera"));
    Scene point = one_sphere();
    point.cut.bounds = {Vec3(3), Vec3(3)};
    EXPECT_THAT(point.text(), HasSubstr("camera"));
}

} // namespace
} // namespace graftal
