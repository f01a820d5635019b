#pragma once

#include "compiler/import/cpfg/system.h"

namespace graftal {

/// cpfg has modules of one letter only, but its decompositions and homomorphisms may be for several that
/// stand side by side: `Sl --> ...`. Where these modules are one name in all that they do, each such sequence
/// becomes a module of that name.
void join_cpfg_names(CpfgSystem& system);

} // namespace graftal
