#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/graph/primitive.h"

namespace graftal {

using PlanePoint = std::array<double, 2>; ///< x, y

/// The corners of closed rings in a plane, one ring after the other.
struct PolygonRings {
    std::vector<PlanePoint> corners;
    std::vector<std::uint32_t> ring_ends; ///< behind the last corner of each ring
};

/// Rings from a list of points, as POV-Ray's polygon has them: a ring ends where its first point comes
/// again; the last may be left open. Nothing, and the fault, where a ring has fewer than three corners or no
/// area, or where rings cross or touch. O(corners^2).
std::optional<PolygonRings> polygon_rings(std::span<const PlanePoint> points, std::string& fault);

/// Triangles over the rings' corners that fill the points inside an odd number of rings, counter-clockwise.
/// Requires rings of polygon_rings().
std::vector<std::array<std::uint32_t, 3>> triangulate(const PolygonRings& rings);

/// The rings of a polygon.
const PolygonRings& rings_of(const Primitive& polygon);

} // namespace graftal
