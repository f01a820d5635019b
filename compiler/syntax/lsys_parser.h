#pragma once

#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/lsys_ast.h"

namespace graftal {

/// Parses a `.lsys` file; errors are reported, and the tree holds what could be read. Names in expressions
/// and models are not looked up. O(text).
LsysFile parse_lsys(const SourceMap& sources, FileId file, Diagnostics& diagnostics);

} // namespace graftal
