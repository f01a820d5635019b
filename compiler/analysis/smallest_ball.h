#pragma once

#include <span>
#include <vector>

#include "compiler/support/bounds.h"

namespace graftal {

/// The smallest ball that holds all of `balls` (to about 1e-9 of its radius; it holds them in any case).
/// Basis exchange with the farthest ball (Welzl 1991; Fischer and Gaertner 2003). An empty ball for none.
Ball smallest_ball(std::span<const Ball> balls);

} // namespace graftal
