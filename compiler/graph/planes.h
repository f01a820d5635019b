#pragma once

#include <vector>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// A flag for each object: whether it is a plane, or reaches one by instances. O(graph).
std::vector<bool> plane_holders(const Graph& graph, const Components& components);

} // namespace graftal
