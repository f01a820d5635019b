#pragma once

#include "compiler/unfolded/drawn_bounds.h"

namespace graftal {

/// Whether some object has thin parts that cover each other and lie nearer, one over the other, than single
/// precision tells: the paper cuts and drawings of other programs, whose layers are thousandths of a pixel
/// apart. Those that lie in one plane in double precision, too, do not count. `ray_length`: of rays that show
/// all objects in one size; else 0. O(n log n) in parts, nearly.
bool has_near_layers(const DrawnBounds& bounds, double ray_length);

} // namespace graftal
