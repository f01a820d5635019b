#pragma once

#include "compiler/support/affine.h"

namespace graftal {

/// The map from normals of a surface to those of its image, up to a positive factor: the inverse transpose,
/// by the cofactors. A segment 1e100 times as long as thick has an inverse that doubles do not hold.
Mat3 normal_map(const Mat3& linear);

} // namespace graftal
