#pragma once

#include <string>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// The graph in Graphviz's DOT. A node is an object (primitives as boxes, the root doubled), an edge a pair
/// of objects with the number of instances between them, a cluster a cycle. Deterministic.
std::string emit_dot(const Graph& graph, const Components& components);

} // namespace graftal
