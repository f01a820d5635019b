#pragma once

#include <vector>

#include "compiler/lsys/parse/ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/syntax/expression_cells.h"

namespace graftal {

/// Numbers the cells of a block's variables, and gives their first values. Reports duplicates, sizes that are
/// none, and wrong numbers of values. `lets`: those that first values and sizes may use; those of the file
/// that a variable hides are taken away. A variable `changes` if some block assigns to its name.
CellPlaces declare_variables(const LsysBlock& block, Environment& lets, std::vector<double>& first_cells,
                             Diagnostics& diagnostics);

} // namespace graftal
