#pragma once

#include <vector>

#include "compiler/support/tint.h"
#include "runtime/inverse/target.h"

namespace graftal {

/// Tints of a system's maps, all with one alpha: a point of address i1 i2 ... has the colour
/// a c(i1) + (1 - a) (a c(i2) + ...), as tints in front of each other show it (Hart 1992, eq. 9 and 10).
struct SystemColours {
    std::vector<Rgb> of_map; ///< linear, in [0, 1]
    double alpha = 1;
    double rms_255 = 0; ///< from the target's colours, over the cells that both have, in levels of sRGB
};

/// The tints by least squares over the cells of the attractor, for the best of some alphas. `colours`: of the
/// target's points, in their order. Requires contractions, in cells.
SystemColours fit_colours(const Target& target, const PlaneMaps& maps, const std::vector<Rgb>& colours);

} // namespace graftal
