#pragma once

#include <cstdint>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// The first crossing of the primitive's surface within the range, exact to rounding; solids are met from
/// inside too. False if there is none, and where the ray's numbers are not finite. Requires that the ray's
/// origin is within some thousand units of the primitive. Requires that the largest component of its
/// direction is about 1 in absolute value: rays are brought near before they are intersected. A primitive of
/// many triangles takes `most_steps` at most (TriangleTree::meet()).
bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit,
               std::uint64_t most_steps = UINT64_MAX);

} // namespace graftal
