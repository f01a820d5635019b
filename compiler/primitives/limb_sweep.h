#pragma once

// limb_sweep(sides, collar, depth, x, y, z, r, ...): the skin of a limb, one closed surface about a chain of
// points.

#include <cstddef>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// More points are refused.
inline constexpr std::size_t most_limb_points = 300;
inline constexpr int least_limb_sides = 3, most_limb_sides = 64;

/// The shares of the radius by which rings of the most, and nearly the fewest, sides stray from a circle.
inline constexpr double least_limb_tolerance = 0.001, most_limb_tolerance = 0.3;

/// The fewest sides of a ring that strays from a circle by at most this share of its radius. A ring has the
/// area of its circle, and so lies half inside and half outside of it.
int limb_sides(double tolerance);

/// The share of the radius by which such a ring lies inside its circle in the middle of a side.
double limb_dent(int sides);

/// Number of triangles. Requires a primitive of this kind.
std::size_t limb_triangles(const Primitive& limb);

} // namespace graftal
