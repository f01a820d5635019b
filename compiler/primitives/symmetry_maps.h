#pragma once

#include "compiler/graph/primitive.h"
#include "compiler/support/affine.h"

namespace graftal {

/// Entries that differ by less are equal, as far as symmetries go.
inline constexpr double symmetry_tolerance = 1e-9;

/// Whether every entry is less than the tolerance times `scale`.
bool is_near_zero(const Mat3& m, double scale);

bool is_orthogonal(const Mat3& m);

/// Whether it is an isometry that leaves the origin where it is.
bool turns_about_origin(const Affine& map);

/// The point that such maps leave where it is, as a column of the table of primitives.
inline Vec3 origin_of(const Primitive&) {
    return Vec3(0.0);
}

/// Whether an orthogonal map takes the y axis to itself, perhaps turned over.
bool keeps_y_axis(const Mat3& m);

} // namespace graftal
