#pragma once

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/parse/ast.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// Values of the statements that say what acts upon the turtle from outside (`tropism`, `bending`,
/// `environment`), in the grammar, whose `lets` are known. Reports faults.
void build_surroundings(const LsysBlock& block, LsysGrammar& grammar, Diagnostics& diagnostics);

} // namespace graftal
