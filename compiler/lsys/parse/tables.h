#pragma once

#include "compiler/lsys/parse/ast.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

/// Connects the calls in a block's expressions with the tables that they name.
void connect_tables(LsysBlock& block, const ExpressionTables& tables);

} // namespace graftal
