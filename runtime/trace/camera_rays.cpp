#include "runtime/trace/camera_rays.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/support/check.h"

namespace graftal {

CameraRays::CameraRays(const View& view) : camera_(view.camera), size_(view.size) {
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

std::vector<PixelSample> povray_samples_of_pixel(int depth) {
    GRAFTAL_CHECK(1 <= depth && depth <= 9, "trace: POV-Ray has no such antialiasing");
    const int cells = 1 << (depth - 1);
    // Along a line each cell gives half its share to either end.
    const auto share = [&](int i) { return (i == 0 || i == cells ? 0.5 : 1.0) / cells; };
    std::vector<PixelSample> samples;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i)
            samples.push_back(
                {static_cast<double>(i) / cells, static_cast<double>(j) / cells, share(i) * share(j)});
    return samples;
}

} // namespace graftal
