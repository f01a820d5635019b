#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal {

/// Most corners of an outline: rays look at each.
inline constexpr std::size_t most_outline_corners = 256;

/// A flat polygon as the numbers of a `polygon`, and its place.
struct PolygonOutline {
    std::vector<double> numbers;
    Affine start_from_outline; ///< a rotation, a uniform scale and a shift
};

/// The outline of a turtle's polygon. `axes`: the turtle's right, ahead and up where the polygon began. The
/// outline's x points to the right and its y ahead, as far as its plane allows; where the way ahead stands
/// upright on the plane, y points up. Polygons that differ by a rotation, a uniform scale and rounding have
/// equal numbers: their longer side is 1, and their first corner the origin. Corners that lie on the way
/// between their neighbours are left out. Nothing for polygons that are not flat, have no area, come back to
/// their first corner or have too many. A `polygon` refuses those that meet themselves. O(n^2).
std::optional<PolygonOutline> outline_of(std::span<const Vec3> corners, const Mat3& axes);

} // namespace graftal
