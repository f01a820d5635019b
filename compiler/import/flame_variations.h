#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal::flame {

/// What a variation makes of a point (Draves and Reckase, appendix): formulas of x, y, and of r, its distance
/// from the origin, r2, its square, and theta, the angle atan2(x, y) in radians.
struct Formula {
    std::string x, y;
};

/// One for each equally likely branch: `julia` has two. Empty if the variation has no formula here, for it is
/// unknown or draws random numbers. `pre`: the affine part of the map, which some use.
std::vector<Formula> formulas_of(std::string_view variation, const Affine& pre);

/// Whether flam3 knows a variation of this name.
bool is_variation(std::string_view name);

} // namespace graftal::flame
