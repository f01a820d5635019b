#pragma once

#include <string>

#include "compiler/graph/graph.h"

namespace graftal {

/// The graph as `.inst` text (docs/language.md). Reading it back gives an equal() graph, to the last bit of
/// each number. Unused primitives are not written, and levels that instances state are comments, since no
/// model states them. Requires a verified graph. Deterministic, O(graph).
std::string print(const Graph& graph);

/// Its materials and settings alone, as all languages write them.
std::string print_scenery(const Graph& graph);

} // namespace graftal
