#pragma once

#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/importer.h"

namespace graftal::cfdg {

/// Reads a grammar of version 2 or 3, with the files that it includes. Reports what it cannot read.
Grammar parse(const ForeignFile& file);

} // namespace graftal::cfdg
