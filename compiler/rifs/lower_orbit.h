#pragma once

#include "compiler/lower/lowering.h"
#include "compiler/rifs/ast.h"

namespace graftal {

/// Lowers a `.rifs` file with an orbit to LowerNotes::orbit, or reports why not: it must be the root model
/// and stand alone in its file, and the options must allow it (LowerOptions::may_be_orbit).
void lower_orbit_file(const RifsFile& tree, Lowering& lowering);

} // namespace graftal
