#pragma once

#include <cmath>

namespace graftal {

/// The lengths, widths, diameters and scales that a turtle takes: nothing, or a size in this range, of either
/// sign. It goes no farther than the largest. Squares of such numbers, and products with others, are numbers
/// that a double holds.
inline constexpr double least_size = 1e-100;
inline constexpr double largest_size = 1e100;

/// What is smaller than the least, but not nothing, is made the least: it is drawn as thin as can be.
inline double at_least_size(double size) {
    return size == 0 || std::abs(size) >= least_size ? size : std::copysign(least_size, size);
}

} // namespace graftal
