#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// The word of a grammar after these steps as an axiom would have it: `F(1)[+(25)A(0.5)]`, numbers as the
/// shortest decimals that read back to them, and blanks about names of several letters. It is the word before
/// interpretation. Nothing after an error, such as more modules than that. O(modules of all words).
std::optional<std::string> written_word(const LsysGrammar& grammar, unsigned steps, std::uint64_t seed,
                                        std::uint64_t max_modules, WorkMeter* meter,
                                        Diagnostics& diagnostics);

} // namespace graftal
