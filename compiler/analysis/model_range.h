#pragma once

#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// Largest reach of a terminal, in reaches of its object. It stands in for an object that is too small to
/// see.
inline constexpr double farthest_terminal = 1000;

/// Reports, and gives false, where what the graph composes leaves the range of numbers
/// (support/number_range.h): an object, in its own frame, is too far, too large or too small. The same for a
/// terminal that reaches farther than `farthest_terminal` times its object, which a view of the object does
/// not hold. Requires bounds of all objects.
bool check_range(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds,
                 Diagnostics& diagnostics);

} // namespace graftal
