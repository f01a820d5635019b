#include "compiler/scene/sight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace graftal {

bool misses(const Camera& camera, const Box& box, ImageSize size) {
    constexpr double margin_px = 4; // more than thin parts are widened by (least_width.h)
    const double half =
        camera.orthographic ? 0.5 * camera.width : std::tan(camera.angle_deg * std::numbers::pi / 360);
    const double pixel = 2 * half / size.width;
    const double width = half + margin_px * pixel, height = (0.5 * size.height + margin_px) * pixel;
    const auto corners = box.corners();
    const auto all = [&](const auto& outside) {
        return std::ranges::all_of(corners, [&](Vec3 corner) {
            const Vec3 sight = corner - camera.location;
            const Vec3 p(glm::dot(sight, camera.right), glm::dot(sight, camera.up),
                         glm::dot(sight, camera.direction));
            const double reach = camera.orthographic ? 1 : p.z;
            return outside(p, width * reach, height * reach);
        });
    };
    return all([](Vec3 p, double, double) { return p.z < 0; }) ||
           all([](Vec3 p, double w, double) { return p.x > w; }) ||
           all([](Vec3 p, double w, double) { return p.x < -w; }) ||
           all([](Vec3 p, double, double h) { return p.y > h; }) ||
           all([](Vec3 p, double, double h) { return p.y < -h; });
}

} // namespace graftal
