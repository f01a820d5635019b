#pragma once

#include <optional>

#include "compiler/graph/graph.h"
#include "compiler/lsys/parse/ast.h"

namespace graftal {

struct Lowering;

/// Lowers an `.lsys` file (docs/language.md, ".lsys"): the block that is marked `main`, else the last, after
/// its steps or those of the options, composed part by part (compose/composer.h). Faults go to the lowering's
/// diagnostics and give nothing.
std::optional<Graph> lower_lsys(const LsysFile& tree, Lowering& lowering);

} // namespace graftal
