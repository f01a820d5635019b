#pragma once

#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/graph/detail_graph.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Requires a graph after the passes for detail (passes/pipeline.h), and its bounds. O(graph). The meter may
/// be null.
DetailGraph build_detail_graph(Graph graph, const std::vector<ObjectBounds>& bounds,
                               WorkMeter* meter = nullptr);

} // namespace graftal
