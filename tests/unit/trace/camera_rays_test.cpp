#include "runtime/trace/camera_rays.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace graftal {
namespace {

/// A camera at (1, 2, 3) that looks along x, its up on z: right is -y.
View sideways(bool orthographic) {
    View view;
    view.size = {200, 100};
    view.camera = {.location = {1, 2, 3},
                   .direction = {1, 0, 0},
                   .up = {0, 0, 1},
                   .right = {0, -1, 0},
                   .orthographic = orthographic,
                   .angle_deg = 90,
                   .width = 8};
    return view;
}

void expect_near(Vec3 a, Vec3 b) {
    EXPECT_LT(glm::length(a - b), 1e-14) << a.x << " " << a.y << " " << a.z;
}

TEST(CameraRays, PerspectiveRaysLeaveTheEye) {
    const CameraRays rays(sideways(false));
    struct {
        double x, y;
        Vec3 towards;
    } const cases[] = {
        {100, 50, {1, 0, 0}},     {0, 50, {1, 1, 0}},  {200, 50, {1, -1, 0}},         {100, 0, {1, 0, 0.5}},
        {100, 100, {1, 0, -0.5}}, {0, 0, {1, 1, 0.5}}, {0.5, 0.5, {1, 0.995, 0.495}}, {-100, 50, {1, 2, 0}},
    };
    for (const auto& c : cases) {
        const Ray ray = rays.through(c.x, c.y);
        EXPECT_EQ(ray.origin, Vec3(1, 2, 3));
        expect_near(ray.direction, glm::normalize(c.towards));
    }
}

TEST(CameraRays, ParallelRaysLeaveThePlaneOfTheEye) {
    const CameraRays rays(sideways(true));
    struct {
        double x, y;
        Vec3 origin;
    } const cases[] = {{100, 50, {1, 2, 3}}, {0, 0, {1, 6, 5}}, {200, 100, {1, -2, 1}}, {50, 75, {1, 4, 2}}};
    for (const auto& c : cases) {
        const Ray ray = rays.through(c.x, c.y);
        expect_near(ray.origin, c.origin);
        EXPECT_EQ(ray.direction, Vec3(1, 0, 0));
    }
}

TEST(CameraRays, SpanTheAngleOfViewAtUnitLength) {
    View view = sideways(false);
    view.size = {64, 200};
    view.camera.angle_deg = 30;
    const CameraRays rays(view);
    const Vec3 left = rays.through(0, 100).direction, right = rays.through(64, 100).direction;
    EXPECT_NEAR(glm::length(left), 1, 1e-15);
    EXPECT_NEAR(std::acos(glm::dot(left, right)), std::numbers::pi / 6, 1e-13);
}

} // namespace
} // namespace graftal
