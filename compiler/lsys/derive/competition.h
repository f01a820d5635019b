#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/support/counter_random.h"

// The rule by which chance chooses one of the productions that fit a module.

namespace graftal {

/// Number of sets that a rule's random numbers are drawn in, all of a set together. For each call the values
/// are spread evenly over the distribution (a Latin hypercube): mean and variance over the sets are those of
/// the distribution. A power of two.
inline constexpr std::uint32_t draw_sets = 64;

/// The draw that a rule's random numbers follow from.
struct RuleDraw {
    std::uint32_t set = 0; ///< of the draw_sets, or, without a pool,
    std::uint64_t own = 0; ///< the module's draw
};

/// A rule that fits a module. The draws that choose it are those after its predecessor's last one, up to its
/// own last one.
struct Competitor {
    const LsysRule* rule = nullptr;
    double probability = 1;
    std::uint64_t last_draw = UINT64_MAX;
};

/// The draw of 64 bits below which this share of all draws lies.
inline std::uint64_t draw_at(double share) {
    const double scaled = std::ldexp(share, 64);
    return scaled < 0x1p64 ? static_cast<std::uint64_t>(scaled) : UINT64_MAX;
}

/// Lays the draws of competitors end to end, as many each as its probability says. Those of no probability
/// leave. Requires the sum of the probabilities, above 0.
template<typename Entrant> void share_draws(std::vector<Entrant>& entrants, double sum) {
    std::erase_if(entrants, [](const Entrant& entrant) { return entrant.probability == 0; });
    double below = 0;
    for (Entrant& entrant : entrants) {
        below += entrant.probability / sum;
        entrant.last_draw = draw_at(below);
    }
    entrants.back().last_draw = UINT64_MAX;
}

/// The competitor that a draw has chosen.
template<typename Entrant> struct Winner {
    const Entrant* entrant = nullptr;
    std::uint64_t inside = 0; ///< the draw, counted from where the winner's draws begin
    std::uint64_t width = 0;  ///< number of the winner's draws

    /// The random numbers for a draw of chance: the set has nothing to do with the choice.
    RuleDraw scattered() const {
        return {static_cast<std::uint32_t>(CounterRandom::scrambled(inside) % draw_sets), inside};
    }
    /// The random numbers for one of evenly spread draws: the sets are spread evenly, too.
    RuleDraw even() const {
        const double share = static_cast<double>(inside) / std::max(1.0, static_cast<double>(width));
        return {std::min(draw_sets - 1, static_cast<std::uint32_t>(share * draw_sets)), inside};
    }
};

/// The competitor that a draw chooses: `first`, or one of those after it. Requires that they share all draws.
template<typename Entrant> Winner<Entrant> choose(const Entrant* first, std::uint64_t draw) {
    std::uint64_t below = 0;
    while (draw > first->last_draw)
        below = (first++)->last_draw;
    return {first, draw - below, first->last_draw - below};
}

} // namespace graftal
