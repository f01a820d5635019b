#pragma once

// Functions that the meshes of round primitives share.

#include <cstdint>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// The radius of a regular n-gon that strays equally from the unit circle at its corners (outside) and at
/// the middles of its sides (inside).
double balanced_radius(int sides);
/// The length by which the n-gon of balanced_radius() strays from the unit circle.
double balanced_error(int sides);

/// The unit direction i/n of a turn about the y axis, running from +z to +x: counter-clockwise seen from
/// above.
Vec3 spoke(int i, int n);

/// Returns the number of the vertex.
std::uint32_t add_vertex(TessellatedPrimitive& mesh, Vec3 position, Vec3 normal);

} // namespace graftal
