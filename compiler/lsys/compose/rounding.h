#pragma once

#include <deque>

#include "compiler/lsys/compose/sizes.h"

namespace graftal {

/// Differences that are ignored when parts are looked up.
struct Rounding {
    bool resizes = false; ///< modules that differ in their size only
    double size_step = 0;
    double snap_angle_deg = 0;
};

/// Whether parts differ in their sizes only.
bool has_sizes(const LsysGrammar& grammar, const LsysSizes& sizes);

/// Whether parts look at the directions of the world.
bool uses_directions(const LsysGrammar& grammar);

/// The roundings that are of use to a grammar, from exact to coarse.
std::deque<Rounding> roundings_of(const LsysGrammar& grammar, const LsysSizes& sizes);

} // namespace graftal
