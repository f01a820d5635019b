#pragma once

#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/graph/cut_graph.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Requires a graph after the passes for detail (passes/pipeline.h), and its bounds. O(graph). The meter may
/// be null.
CutGraph build_cut_graph(Graph graph, const std::vector<ObjectBounds>& bounds, WorkMeter* meter = nullptr);

} // namespace graftal
