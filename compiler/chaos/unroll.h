#pragma once

#include <cstddef>
#include <optional>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// The graph cut after `steps` levels (graph.h, "Levels") as one without cycles: an object for every unending
/// one and every number of levels left to it. Where an object is cut stands its terminal; else what it has
/// that ends; else the ball around it. Nothing if that makes more than `max_instances`.
std::optional<Graph> unrolled(const Graph& graph, const Components& components,
                              const std::vector<ObjectBounds>& bounds, unsigned steps,
                              std::size_t max_instances);

} // namespace graftal
