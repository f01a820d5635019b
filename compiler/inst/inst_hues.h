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

/// The fraction of a turn with a denominator of at most 3600 that the degrees are, to rounding: tenths of a
/// degree, or 360/7. Nothing for other degrees.
std::optional<HueTurn> exact_turn(double degrees);
/// The nearest whole degree.
HueTurn whole_degrees(double degrees);

/// Nothing if the denominator would exceed a million.
std::optional<HueTurn> sum(HueTurn a, HueTurn b);

/// How far the instances of an object turn the colours of what they show.
struct ObjectHues {
    std::vector<HueTurn> instances; ///< as many as the object has
    HueTurn terminal;
};

/// By object; others have no turns.
using HueTable = std::map<ObjectId, ObjectHues>;

/// Carries out the turns: an object that is reached with different sums of turns stands in the graph once for
/// each, with its tints and materials turned. Sums are exact fractions, so around a cycle that turns by p/q
/// there are q states, and the colours repeat for ever as they should. Greys and the pictures of materials
/// stay; the latter are noted. Errors, at `place`: more objects than the options allow, sums without a small
/// common denominator.
bool apply_hues(Graph& graph, const HueTable& hues, Span place, Lowering& lowering);

} // namespace graftal
