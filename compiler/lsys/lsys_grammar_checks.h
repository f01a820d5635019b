#pragma once

#include <cstddef>
#include <vector>

#include "compiler/lsys/lsys_grammar.h"

// What is legal in a grammar, but hardly meant.

namespace graftal {

/// A module of the axiom or of a successor.
struct LsysUse {
    SymbolId symbol;
    std::size_t arity;
    Span span;
};

/// Reports symbols that mean nothing, and warns of modules that no production rewrites and the turtle does
/// not draw.
void check_symbols(const LsysGrammar& grammar, const std::vector<LsysUse>& uses, Diagnostics& diagnostics);

/// Warns of contexts, and of several modules before an arrow, that never match.
void check_patterns(const LsysGrammar& grammar, const std::vector<LsysUse>& uses, Diagnostics& diagnostics);

} // namespace graftal
