#pragma once

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/turtle/length_tally.h"

// How thick segments are where a block does not say it by `width`.

namespace graftal {

/// Whether segments are lines: nothing in the block says how thick they are.
bool draws_lines(const LsysGrammar& grammar);

/// Whether the width that the turtle starts with depends on the figure.
bool has_open_width(const LsysGrammar& grammar);

/// By so much the width is multiplied where a branch begins. Of a plant drawn in lines, twigs are finer than
/// the trunk. It is taken for a plant if it has branches, and its axiom has none: what is put together
/// around a point, as tilings are, has lines of one width. So has what has polygons, and segments of several
/// lengths: each would come in several widths too.
double branch_taper(const LsysGrammar& grammar);

/// The width, or the thickness, that the turtle starts with, if it is not open; else one to go on with until
/// the figure is known.
double stated_width(const LsysGrammar& grammar);

/// The width that the turtle starts with, of a figure with these segments that reaches so far from its start.
/// Lines are as thick as the figure asks, but thinner than the longest segment is long, and not so thin that
/// those segments vanish that make up most of the line. Requires some segments.
double width_for(const LsysGrammar& grammar, const LengthTally& lengths, double reach);

} // namespace graftal
