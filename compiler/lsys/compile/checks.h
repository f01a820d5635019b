#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "compiler/lsys/compile/grammar.h"

// Warnings of grammars that are legal, but hardly meant.

namespace graftal {

/// A module of the axiom or of a successor.
struct LsysUse {
    SymbolId symbol;
    std::size_t arity;
    Span span;
};

bool is_bracket(const LsysGrammar& grammar, SymbolId id);
/// "2 parameters", "no parameters"
std::string parameter_count(std::size_t parameters);

/// Reports symbols that mean nothing. Warns of modules that no production rewrites and the turtle does not
/// draw, and of productions that never apply.
void check_grammar(const LsysGrammar& grammar, const std::vector<LsysUse>& uses, Diagnostics& diagnostics);

/// Warns of each production that never applies, whatever the number of steps. Gives the symbols whose modules
/// have other numbers of parameters than these productions ask for.
std::set<SymbolId> warn_of_idle_productions(const LsysGrammar& grammar, const std::vector<LsysUse>& uses,
                                            Diagnostics& diagnostics);

} // namespace graftal
