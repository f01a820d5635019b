#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal::flame {

/// The image of a point under a variation (Draves and Reckase, appendix): formulas of x, y, and of r, its
/// distance from the origin, r2, its square, and theta, the angle atan2(x, y) in radians.
struct Formula {
    std::string x, y;
    /// Random numbers that both read, as `NAME# = number, ...`, each `#` a number of the variation's own; or
    /// "".
    std::string draws = {};
};

/// The values that a variation may read besides the point.
struct Setting {
    const Affine& pre; ///< the affine part of its map
    double weight = 1;
    /// A number of the map, such as `julian_power`, or what it is where the file says none.
    std::function<double(const std::string& name, double otherwise)> number;
};

/// One for each equally likely branch: `julia` has two. Empty if the variation has no formula here.
std::vector<Formula> formulas_of(std::string_view variation, const Setting& setting);

/// Whether it moves the point before all others of its map read it: its formula is then what it adds.
bool comes_first(std::string_view variation);

/// Whether it moves points off the plane only, as `flatten`: it changes nothing here.
bool leaves_the_plane(std::string_view name);

/// Whether flam3 knows a variation of this name.
bool is_variation(std::string_view name);

} // namespace graftal::flame
