#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/scene/scene.h"

namespace graftal {

/// Where points fall on a picture: the other way round of trace/camera_rays.h.
class PointProjection {
  public:
    PointProjection(const Camera& camera, ImageSize size)
        : eye_(camera.location), direction_(camera.direction), perspective_(!camera.orthographic),
          size_(size) {
        const double half_width =
            camera.orthographic ? 0.5 * camera.width : std::tan(camera.angle_deg * std::numbers::pi / 360);
        const double scale = 0.5 * size.width / half_width;
        across_ = scale * camera.right;
        down_ = -scale * camera.up;
    }

    /// The pixel that the point falls into, counted row by row; nothing if it falls beside the picture or
    /// behind the eye.
    std::optional<std::size_t> pixel_of(Vec3 point) const {
        const Vec3 sight = point - eye_;
        double x = glm::dot(sight, across_), y = glm::dot(sight, down_);
        if (perspective_) {
            const double depth = glm::dot(sight, direction_);
            if (!(depth > 0)) return std::nullopt;
            x /= depth;
            y /= depth;
        }
        x += 0.5 * size_.width;
        y += 0.5 * size_.height;
        if (!(x >= 0 && y >= 0 && x < size_.width && y < size_.height)) return std::nullopt;
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
               static_cast<std::size_t>(x);
    }

    /// Where points are as the picture has them: of parallel rays x and y in pixels; else these must be
    /// divided by z, the depth, and are from the middle on.
    Affine picture_from_world() const {
        Affine turned;
        turned.linear = glm::transpose(Mat3(across_, down_, direction_));
        turned.translation = -(turned.linear * eye_);
        if (!perspective_) turned.translation += 0.5 * Vec3(size_.width, size_.height, 0);
        return turned;
    }
    bool perspective() const { return perspective_; }

  private:
    Vec3 eye_, direction_, across_, down_;
    bool perspective_;
    ImageSize size_;
};

} // namespace graftal
