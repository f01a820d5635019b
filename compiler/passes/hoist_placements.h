#pragma once

#include "compiler/graph/graph.h"
#include "compiler/passes/renumbering.h"

namespace graftal {

/// Moves what all instances of an object share, map, tint and material, to the instances that lead to the
/// object, so that the attractors of an IFS, all images of one set, become equal. Of an ending object of one
/// instance nothing is left: its users lead to its master. The root and objects whose shared map is singular
/// stay as they are.
/// Ensures: unfolds to the same, except for rounding where maps meet, and leaves objects without users.
/// States no chances: those of a moved instance would be another object's. O(graph).
Rewritten hoist_placements(Graph graph);

} // namespace graftal
