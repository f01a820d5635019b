#pragma once

#include "compiler/lsys/compile/grammar.h"

// Settings of a block: angle, sizes, taper, skin, seed and steps.

namespace graftal {

/// Fills in what a block says of its turtle, its seed and its steps. Reports values out of range. The names
/// of variables, which have no one value, must be known.
void build_settings(const LsysBlock& block, LsysGrammar& grammar, Diagnostics& diagnostics);

} // namespace graftal
