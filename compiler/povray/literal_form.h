#pragma once

#include "compiler/graph/graph.h"

namespace graftal {

/// Whether the map leaves the primitive of its kind, so that POV-Ray's own statement for it says all, and no
/// matrix is needed: balls stay balls, boxes stay boxes along the axes, and round bodies stay upright on
/// their circles. Lengths and angles that differ by less than 1e-12 are equal.
bool needs_no_matrix(PrimitiveKind kind, const Mat3& linear);

} // namespace graftal
