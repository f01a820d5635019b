#pragma once

#include <optional>
#include <span>

#include "compiler/support/affine.h"

namespace graftal {

/// The flat map of two columns and an offset, whose z are 0. It scales z by sqrt|det|, so that joint spectral
/// radii and similarities stay what they were in the plane.
Affine flat_map(Vec3 x, Vec3 y, Vec3 offset);

/// The affine map that takes each point to its image. Of two points of the plane z = 0 it is the similarity
/// that does not mirror, of three the flat map; four make a map of space. Nothing where the points lie in a
/// space of fewer dimensions. Requires as many images as points, two to four.
std::optional<Affine> map_by_points(std::span<const Vec3> points, std::span<const Vec3> images);

} // namespace graftal
