#pragma once

#include <vector>

#include "compiler/povray/cut/cut.h"
#include "runtime/trace/shade/surfaces.h"

namespace graftal {

/// The placements of a cut as surfaces for the shader, by trying all of them: spheres, cubes, planes and
/// triangles, the equations as plain as can be. Fails the test if there is anything else in it. Keeps a
/// reference to the cut.
class BruteForce : public Surfaces {
  public:
    explicit BruteForce(const Cut& cut);

    bool closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) override;
    bool meets_any(const Ray& ray, const RayRange& range) override;

  private:
    struct Part {
        Primitive kind = PrimitiveKind::sphere;
        Affine part_from_world;
        Rgb rgb;
        const Material* material;
    };
    std::vector<Part> parts_;
};

} // namespace graftal
