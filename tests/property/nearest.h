#pragma once

#include <vector>

#include "compiler/support/affine.h"

namespace graftal::testing {

/// The distance from each of some points to the nearest of others; the largest.
double farthest_from(const std::vector<Vec3>& others, const std::vector<Vec3>& points);

} // namespace graftal::testing
