#pragma once

#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lsys/compile/grammar.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// The materials of the colour indices 0, 1, 2, ...: those that the block names, of the graph or of those
/// that every model knows, else ours. Nothing after the error that one is unknown.
std::optional<std::vector<Material>> palette_of(const LsysGrammar& grammar, const Graph& graph,
                                                Diagnostics& diagnostics);

} // namespace graftal
