#pragma once

// Primitives as solids, which operands of combined objects are (graph.h).

#include "compiler/primitives/primitive.h"

namespace graftal {

/// Whether the primitive encloses a volume. A plane is the half space below it, and a mesh has to be closed.
bool encloses_volume(const Primitive& primitive);

/// Whether the ray leaves the solid where it was met, else it enters. Requires encloses_volume().
bool leaves_solid(const Primitive& primitive, const Ray& ray, const PrimitiveHit& hit);

} // namespace graftal
