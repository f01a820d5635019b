#pragma once

#include "runtime/trace/intersect.h"

namespace graftal {

/// intersect() for the torus. Requires numbers of a size that can be squared, and a direction that is not
/// zero.
bool intersect_torus(const Ray& ray, const RayRange& range, PrimitiveHit& hit);

} // namespace graftal
