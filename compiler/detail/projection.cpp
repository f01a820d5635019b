#include "compiler/detail/projection.h"

#include <numbers>

namespace graftal {

Projection::Projection(const View& view, const DetailOptions& options, double error_px, double near)
    : camera_(view.camera), visible_only_(options.visible_only), width_px_(view.size.width),
      pixels_per_tangent_(0.5 * view.size.width /
                          std::tan(0.5 * view.camera.angle_deg * std::numbers::pi / 180)),
      near_(near), error_px_(error_px), error_world_(options.error_world.value_or(0)),
      culls_(options.error_world ? *options.error_world > 0 : error_px > 0) {
    const double height_share = static_cast<double>(view.size.height) / view.size.width;
    if (camera_.orthographic) {
        edges_[0] = {0.5 * camera_.width, 1};
        edges_[1] = {0.5 * camera_.width * height_share, 1};
        return;
    }
    for (int i = 0; i < 2; ++i) {
        const double tangent = (i == 0 ? 1 : height_share) * 0.5 * view.size.width / pixels_per_tangent_;
        edges_[i] = {tangent / std::hypot(1, tangent), 1 / std::hypot(1, tangent)};
    }
}

} // namespace graftal
