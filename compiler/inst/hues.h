#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/lowering.h"

namespace graftal {

/// A share of a whole turn of the colour circle, part/whole in lowest terms, in [0, 1).
struct HueTurn {
    std::int64_t part = 0;
    std::int64_t whole = 1;

    double turns() const { return static_cast<double>(part) / static_cast<double>(whole); }
    auto operator<=>(const HueTurn&) const = default;
};

/// The fraction of a turn, with a denominator of at most 3600, that equals the degrees up to rounding: tenths
/// of a degree, or 360/7. Nothing for other degrees.
std::optional<HueTurn> exact_turn(double degrees);
/// The nearest whole degree.
HueTurn whole_degrees(double degrees);

/// Nothing if the denominator would exceed 100,000: a recursion has as many states.
std::optional<HueTurn> sum(HueTurn a, HueTurn b);

/// The turns of the colours on the way from an object to the masters of its instances.
struct ObjectHues {
    std::vector<HueTurn> instances; ///< as many as the object has
    HueTurn terminal;
};

/// The turns by object; objects that it does not name have none.
using HueTable = std::map<ObjectId, ObjectHues>;

/// Carries out the turns. If paths reach an object with different sums of turns, the graph gets one copy of
/// it for each sum, with turned tints and materials. Sums are exact fractions, so a cycle that turns by p/q
/// has q states, and its colours repeat for ever. Greys stay, and so do the pictures of materials, with a
/// note. Where there would be too many for the work allowed, leaves_out_colours() may leave the graph as it
/// is. Errors, at `place`: more objects than the options allow, and sums without a small common denominator.
bool apply_hues(Graph& graph, const HueTable& hues, Span place, Lowering& lowering);

} // namespace graftal
