#pragma once

#include "compiler/lower/lowering.h"
#include "compiler/lsys/parse/ast.h"

namespace graftal {

/// The block that is the model, as `--set angle=40` has it: with these values of its settings and variables.
/// Notes the settings as parameters of the model. `lets`: the values of the file's and the block's `let`s.
LsysBlock set_block(LsysBlock block, Environment lets, Lowering& lowering);

} // namespace graftal
