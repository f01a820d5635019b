#pragma once

#include "compiler/graph/graph.h"
#include "runtime/trace/ray.h"

namespace graftal {

/// Where a ray meets a canonical primitive.
struct PrimitiveHit {
    double t = 0;
    Vec3 normal{0, 1, 0}; ///< in the primitive's frame, outwards (of the triangle: +z, of the plane: +y), of
                          ///< unit length
};

/// The first crossing of the primitive's surface within the range, exact to rounding; solids are met from
/// inside too. False if there is none, and where the ray's numbers are not finite. Requires of the ray that
/// its origin is within some thousand units of the primitive and that the largest component of its
/// direction has an absolute value of about 1: rays are brought near before they are intersected.
bool intersect(PrimitiveKind kind, const Ray& ray, const RayRange& range, PrimitiveHit& hit);

} // namespace graftal
