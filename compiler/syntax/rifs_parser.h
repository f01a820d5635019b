#pragma once

#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/rifs_ast.h"

namespace graftal {

/// Parses a `.rifs` file; errors are reported, and the tree holds what could be read. Names are not looked
/// up. O(text).
RifsFile parse_rifs(const SourceMap& sources, FileId file, Diagnostics& diagnostics);

} // namespace graftal
