#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "compiler/lsys/walk/plant.h"

namespace graftal {

/// The word of a grammar after these steps, in the rewriter's table. Nothing after an error, such as more
/// modules than that. O(modules of all words).
std::optional<ModuleString> derived_word(LsysRewriter& rewriter, unsigned steps, std::uint64_t seed,
                                         std::uint64_t max_modules, Diagnostics& diagnostics);

/// A word as an axiom would have it: `F(1)[+(25)A(0.5)]`, numbers as the shortest decimals that read back to
/// them, and blanks about names of several letters. It is the word before interpretation.
std::string written_word(const DerivedWord& derived);

} // namespace graftal
