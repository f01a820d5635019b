#pragma once

#include <cstdint>
#include <optional>

#include "compiler/lower/plant.h"
#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/derive/deriver.h"
#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// A word with the table that its modules are in.
struct DerivedWord {
    LsysRewriter& rewriter;
    ModuleString word;
    unsigned steps;
};

/// The modules of a word with their places, as a turtle meets them: those of letters that mean nothing to it,
/// and of what draws segments, balls, discs and models. Moves, turns and widths are none. Nothing after an
/// error. O(modules that are drawn).
std::optional<Plant> plant_of(const DerivedWord& derived, std::uint64_t seed, Diagnostics& diagnostics);

} // namespace graftal
