#pragma once

#include "compiler/graph/graph.h"
#include "compiler/passes/renumbering.h"

namespace graftal {

/// Moves the map, tint and material that all instances of an object share to the instances that lead to the
/// object. So the attractors of an IFS, all images of one set, become equal. An ending object of one
/// instance goes: its users lead to its master. The root and objects whose shared map is singular stay as
/// they are. Ensures: unfolds to the same, except for rounding where maps meet, and leaves objects without
/// users. States no chances: those of a moved instance would be another object's. O(graph).
Rewritten hoist_placements(Graph graph);

} // namespace graftal
