#pragma once

// Primitives as solids, which operands of combined objects are (graph.h).

#include <optional>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// Whether the primitive encloses a volume. A plane is the half space below it, and a mesh has to be closed.
bool encloses_volume(const Primitive& primitive);

/// The volume that it encloses, 0 if none; nothing where that is not known, and of a plane. That of a mesh is
/// right unless it goes through itself.
std::optional<double> volume_of(const Primitive& primitive);

/// Whether the ray leaves the solid where it was met, else it enters. Requires encloses_volume().
bool leaves_solid(const Primitive& primitive, const Ray& ray, const PrimitiveHit& hit);

} // namespace graftal
