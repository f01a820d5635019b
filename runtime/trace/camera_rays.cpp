#include "runtime/trace/camera_rays.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace graftal {

CameraRays::CameraRays(const View& view) : camera_(view.camera), lens_(view.lens), size_(view.size) {
    half_width_ =
        camera_.orthographic ? 0.5 * camera_.width : std::tan(camera_.angle_deg * std::numbers::pi / 360);
    half_height_ = half_width_ * size_.height / size_.width;
}

Ray CameraRays::through(double x, double y) const {
    const Vec3 across = half_width_ * (2 * x / size_.width - 1) * camera_.right +
                        half_height_ * (1 - 2 * y / size_.height) * camera_.up;
    if (camera_.orthographic) return {camera_.location + across, camera_.direction};
    return {camera_.location, glm::normalize(camera_.direction + across)};
}

Ray CameraRays::through(double x, double y, glm::dvec2 place) const {
    const Ray middle = through(x, y);
    const double radius = lens_.radius * std::sqrt(place.x), turn = 2 * std::numbers::pi * place.y;
    const Vec3 aside = radius * (std::cos(turn) * camera_.right + std::sin(turn) * camera_.up);
    const Vec3 sharp = middle(lens_.depth / glm::dot(middle.direction, camera_.direction));
    const Vec3 from = camera_.location + aside;
    return {from, glm::normalize(sharp - from)};
}

} // namespace graftal
