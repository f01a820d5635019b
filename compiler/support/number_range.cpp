#include "compiler/support/number_range.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr double room = 10; ///< for rounding, and for turning a map of an end's size

} // namespace

std::string range_fault(const Affine& map) {
    const double stretch = largest_entry(map.linear);
    if (stretch == 0) return "maps everything to one point";
    // Not the other way round: what is no number is no smaller either.
    if (!is_finite(map) || !(stretch <= room * largest_size))
        return fmt::format("stretches by more than {}", shortest(largest_size));
    if (!(largest_entry(map.translation) <= room * largest_size))
        return fmt::format("moves by more than {} units", shortest(largest_size));
    if (stretch < least_size / room) return fmt::format("shrinks to less than {}", shortest(least_size));
    return {};
}

std::string range_fault(Vec3 low, Vec3 high) {
    if (!(std::max(largest_entry(low), largest_entry(high)) <= largest_size))
        return fmt::format("reaches farther than {} units from the origin", shortest(largest_size));
    const double size = largest_entry(high - low);
    if (size > 0 && size < least_size / room)
        return fmt::format("is smaller than {} units", shortest(least_size));
    return {};
}

} // namespace graftal
