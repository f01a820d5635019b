#pragma once

#include <glm/vec2.hpp>

#include "compiler/scene/scene.h"
#include "compiler/support/ray.h"

namespace graftal {

/// Makes the rays of a picture, exactly those of POV-Ray 3.7 through the camera that compiler/povray writes.
class CameraRays {
  public:
    explicit CameraRays(const View& view);

    /// Through the point (x, y) of the picture: in pixels from its upper left corner, so that the first
    /// pixel's middle is (0.5, 0.5). The direction is of unit length.
    Ray through(double x, double y) const;

    bool has_lens() const { return lens_.radius > 0; }
    /// through() from the lens: `place` in [0, 1)^2 spreads evenly over its disc. Requires a lens.
    Ray through(double x, double y, glm::dvec2 place) const;

  private:
    Camera camera_;
    Lens lens_;
    double half_width_; ///< of the picture at distance 1; of parallel rays: in scene units
    double half_height_;
    ImageSize size_;
};

} // namespace graftal
