#pragma once

#include "compiler/inst/inst_ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

/// Parses an `.inst` file (grammar: docs/language.md). All syntax errors of the file are reported; after
/// errors the module holds what was understood.
InstModule parse_inst(const SourceMap& sources, FileId file, Diagnostics& diagnostics);

} // namespace graftal
