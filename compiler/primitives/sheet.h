#pragma once

#include <optional>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// A solid as thin as a sheet: its two faces count as one surface where light comes through it.
struct Sheet {
    Vec3 normal{0, 1, 0}; ///< unit vector, to either side
    double thickness = 0; ///< along the normal; 0: the map is singular
};

/// The sheet that a map makes of a primitive, if it makes one. What encloses no volume is a surface by
/// itself, and no sheet; nor is what the map crushes to a line. `wide`: it is drawn wider than it is, for it
/// has no thickness.
std::optional<Sheet> sheet_of(const Primitive& primitive, const Mat3& linear, bool wide = false);

} // namespace graftal
