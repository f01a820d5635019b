#pragma once

#include "compiler/scene/scene.h"
#include "runtime/trace/surfaces.h"

namespace graftal {

/// Light, as POV-Ray 3.7 computes it for what graftal emits (compiler/emit): ambient, diffuse and specular
/// light of suns and point lights with their shadows, mirrors, the ground and the sky.
class Shader {
  public:
    /// Keeps references to both.
    Shader(const View& view, Surfaces& surfaces);

    /// The light that comes along the ray, from the front; components may exceed 1. The direction is of unit
    /// length.
    Rgb radiance(const Ray& ray);

    /// What the ray meets first, the ground included; false if that is the sky.
    bool first_hit(const Ray& ray, SurfaceHit& hit);

  private:
    const View& view_;
    Surfaces& surfaces_;
};

} // namespace graftal
