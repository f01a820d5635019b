#pragma once

#include "compiler/scene/scene.h"
#include "runtime/trace/ray.h"

namespace graftal {

/// Makes the rays of a picture.
class CameraRays {
  public:
    explicit CameraRays(const View& view);

    /// Through the point (x, y) of the picture: in pixels from its upper left corner, so that the first
    /// pixel's middle is (0.5, 0.5). The direction is of unit length.
    Ray through(double x, double y) const;

  private:
    Camera camera_;
    double half_width_;  ///< of the picture at distance 1; of parallel rays: in scene units
    double half_height_;
    ImageSize size_;
};

} // namespace graftal
