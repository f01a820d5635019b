#pragma once

#include <cmath>
#include <string>

#include "compiler/support/affine.h"

namespace graftal {

/// The range of numbers that a model may use. A length, width or scale, stated or composed, is nothing or
/// lies between these two, of either sign. No coordinate is farther from 0 than the largest. Squares of such
/// numbers, and products with others, are numbers that a double holds: nothing after lowering meets an
/// infinity. A zoom goes deeper, since it gives the model a new root and keeps coordinates near it
/// (zoom/reroot.h).
inline constexpr double least_size = 1e-100;
inline constexpr double largest_size = 1e100;

/// The rule in words, for hints.
inline constexpr const char* range_hint =
    "the sizes and coordinates of a model lie between 1e-100 and 1e+100, and --zoom looks closer than that";

/// Whether a size other than 0 is in the range.
inline bool is_size(double size) {
    return std::abs(size) >= least_size && std::abs(size) <= largest_size;
}

inline bool is_place(Vec3 place) {
    return largest_entry(place) <= largest_size;
}

/// Whether it has a direction, with a length in the range.
inline bool is_direction(Vec3 direction) {
    return is_size(largest_entry(direction));
}

/// The size, or the least size if it is smaller but not 0: it is drawn as thin as can be.
inline double at_least_size(double size) {
    return size == 0 || std::abs(size) >= least_size ? size : std::copysign(least_size, size);
}

/// "stretches by more than 1e+100", "maps everything to one point" or what else is wrong with a map; "" where
/// nothing is. A factor of ten is left for what is turned, or composed of numbers at the ends of the range.
std::string range_fault(const Affine& map);

/// The fault of a thing's reach from the origin, or of its size: "reaches farther than 1e+100 units from the
/// origin", or "is smaller than 1e-100 units"; "" if there is none. A point is no fault.
std::string range_fault(Vec3 low, Vec3 high);

} // namespace graftal
