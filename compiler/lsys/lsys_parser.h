#pragma once

#include "compiler/lsys/lsys_ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

/// Parses a `.lsys` file; errors are reported, and the tree holds what could be read. Names in expressions
/// and models are not looked up. O(text).
LsysFile parse_lsys(const SourceMap& sources, FileId file, Diagnostics& diagnostics);

} // namespace graftal
