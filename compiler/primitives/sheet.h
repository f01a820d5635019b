#pragma once

#include <optional>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// A solid as thin as a sheet: its two faces count as one surface where light comes through it.
struct Sheet {
    Vec3 normal{0, 1, 0}; ///< unit vector, to either side
    double thickness = 0; ///< along the normal; 0: the map is singular
};

/// The most that the thickness of a sheet may be.
struct SheetLimits {
    /// A share of the half axis of a round face of the same area. A turtle's disc has a 25th of it, however
    /// it is stretched within its plane.
    double of_mean = 0.05;
    double of_shorter = 0.5; ///< as a share of the shorter half axis of its faces: thicker ones are rods
};

/// The sheet that a map makes of a primitive, if it makes one. What encloses no volume is a surface by
/// itself, and no sheet; nor is what the map crushes to a line.
std::optional<Sheet> sheet_of(const Primitive& primitive, const Mat3& linear, const SheetLimits& limits = {});

/// Limits of what is drawn wider than it is, for it has no thickness.
inline constexpr SheetLimits sheet_of_wide{0.5, 0.5};

} // namespace graftal
