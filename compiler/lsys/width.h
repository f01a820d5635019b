#pragma once

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/turtle/length_tally.h"

// The thickness of segments where a block does not state it by `width`.

namespace graftal {

/// Whether segments are lines: nothing in the block says how thick they are.
bool draws_lines(const LsysGrammar& grammar);

/// Whether the width that the turtle starts with depends on the figure.
bool has_open_width(const LsysGrammar& grammar);

/// The factor of the width where a branch begins: a plant drawn in lines has finer twigs than its trunk. A
/// plant has branches, but none in its axiom: a figure put together around a point, as tilings are, has
/// lines of one width. Figures with polygons or with segments of several lengths keep one width too: each
/// length would come in several widths.
double branch_taper(const LsysGrammar& grammar);

/// The width, or the thickness, that the turtle starts with, if it is not open; else one to go on with until
/// the figure is known.
double stated_width(const LsysGrammar& grammar);

/// The width that the turtle starts with, for a figure with these segments and this reach from its start.
/// Lines are as thick as the figure asks, but thinner than the longest segment is long. Most of the line's
/// segments stay visible. Requires some segments.
double width_for(const LsysGrammar& grammar, const LengthTally& lengths, double reach);

} // namespace graftal
