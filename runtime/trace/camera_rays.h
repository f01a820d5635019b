#pragma once

#include <vector>

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

/// A point of a pixel, from its upper left corner, and its share of the pixel's light.
struct PixelSample {
    double x = 0.5;
    double y = 0.5;
    double weight = 1;
};

/// Where POV-Ray 3.7 looks through a pixel that it samples once (`-A`): its middle (CreateCameraRay of
/// tracepixel.cpp).
inline constexpr PixelSample povray_sample_of_pixel{};

/// The samples of a pixel under `+A0.0 +AM2 +R<depth> -J`, row by row; the weights add up to 1. POV-Ray
/// halves the pixel depth - 1 times each way and takes the mean of each cell's corners. So the samples are
/// those corners, (2^(depth - 1) + 1) squared, of which neighbouring pixels share the outer ones. Means are
/// taken before anything is clamped. Requires 1 <= depth <= 9, as +R does.
std::vector<PixelSample> povray_samples_of_pixel(int depth);

} // namespace graftal
