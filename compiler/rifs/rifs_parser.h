#pragma once

#include "compiler/rifs/rifs_ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

/// Parses a `.rifs` file; errors are reported, and the tree holds what could be read. Names are not looked
/// up. O(text).
RifsFile parse_rifs(const SourceMap& sources, FileId file, Diagnostics& diagnostics);

} // namespace graftal
