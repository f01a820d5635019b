#pragma once

#include "compiler/graph/graph.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// Reports what a model may write but a graph may not be (graph/verify.h): terminals that do not end,
/// planes in cycles, and combined objects of operands that are no solids. Gives true if there is nothing of
/// it. Requires that the graph is else in order. O(graph).
bool check_graph(const Graph& graph, Diagnostics& diagnostics);

} // namespace graftal
