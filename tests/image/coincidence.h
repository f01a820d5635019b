#pragma once

#include <vector>

#include "compiler/povray/cut/cut.h"
#include "compiler/support/ray.h"

namespace graftal {

/// Tells where parts of a cut lie one in the other, so that nothing says which of them is in front.
class Coincidence {
  public:
    /// Looks at single primitives; meshes are passed over.
    explicit Coincidence(const Cut& cut);

    /// Whether parts of different looks are met at one place: all at t, to rounding.
    bool at(const Ray& ray, double t) const;

  private:
    struct Part {
        Primitive kind = PrimitiveKind::sphere;
        Affine part_from_world;
        Vec3 centre;
        double radius;
        Rgb rgb;
        const Material* material;
    };
    std::vector<Part> parts_;
    double size_ = 0; ///< of coordinates
};

} // namespace graftal
