#pragma once

#include <string>

#include "compiler/graph/graph.h"

namespace graftal {

/// The graph as `.inst` text (docs/language.md); reading it back gives an equal() graph, numbers to the
/// last bit, but for primitives that nothing uses, which are not written, and levels that instances state,
/// which are comments: no model states them. Requires a verified graph. Deterministic, O(graph).
std::string print(const Graph& graph);

} // namespace graftal
