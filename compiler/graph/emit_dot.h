#pragma once

#include <string>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// The graph in Graphviz's DOT: one node an object (primitives as boxes, the root doubled), one edge a pair
/// of objects with the number of instances between them, objects of one cycle in a cluster. Deterministic.
std::string emit_dot(const Graph& graph, const Components& components);

} // namespace graftal
