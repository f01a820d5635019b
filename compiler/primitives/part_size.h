#pragma once

#include "compiler/primitives/primitive.h"

namespace graftal {

/// The size by which a pattern on a part is scaled: half of its extent that is neither the greatest nor the
/// least, as the radius of a branch. 1 where it has no bounds.
double part_size(const Primitive& primitive, const Mat3& world_from_primitive);

} // namespace graftal
