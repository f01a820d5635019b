#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal {

/// Along the normal of the plane that fits a polygon best (Newell's), twice the area long.
Vec3 newell_normal(std::span<const Vec3> corners);

/// Cuts a polygon, given by its corners in order, into triangles over them: ears are clipped in the plane
/// that fits best (Newell's normal). Polygons that cross themselves give triangles too, if not the ones that
/// a filling rule would. Fewer than three corners, or no area, give none. O(n^2), for n up to 10,000.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3> corners);

} // namespace graftal
