#pragma once

#include <cstdint>
#include <functional>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/compile/module_table.h"
#include "compiler/support/diagnostics.h"

// Stages that get whole words between the steps of a derivation.

namespace graftal {

/// Called with the word after the axiom (step 0) and after each step, once the blocks of the step are carried
/// out. It may put other modules in place of some, but not brackets. False after an error, which it reports.
using LsysStage = std::function<bool(std::uint32_t step, ModuleString& word)>;

/// Whether words of the grammar may have cuts.
bool has_cuts(const LsysGrammar& grammar);
/// Takes away what stands from each `%` to the bracket that closes its branch, or to the end. The `%` stays.
void cut_branches(const LsysGrammar& grammar, const ModuleTable& modules, ModuleString& word);

/// Reports that the word after a step is longer than that; false.
bool refuse_length(const LsysGrammar& grammar, std::uint64_t max_modules, std::uint32_t step,
                   Diagnostics& diagnostics);
/// Whether a word is no longer than that; else it is reported.
inline bool is_short_enough(const LsysGrammar& grammar, std::uint64_t length, std::uint64_t max_modules,
                            std::uint32_t step, Diagnostics& diagnostics) {
    return length <= max_modules || refuse_length(grammar, max_modules, step, diagnostics);
}

/// Reports that productions of `interpret` or `decompose` follow each other without end, from one for this
/// symbol on; false.
bool refuse_endless(const LsysGrammar& grammar, RuleKind kind, SymbolId symbol, Span production,
                    Diagnostics& diagnostics);

} // namespace graftal
