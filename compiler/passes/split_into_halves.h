#pragma once

#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/graph.h"
#include "compiler/passes/renumbering.h"

namespace graftal {

/// Splits an unending object that is its own image under a half turn or mirror that leaves none of its
/// instances in place. Its instances of unending masters become two parts (graph.h, "Levels"), images of
/// each other. The choice of the cut gets finer, meshes half as large. Ending instances stay with the whole,
/// which draws it where levels end. Bounded effort (congruent_pairs.h). Requires bounds of all objects.
/// Ensures: unfolds to the same; a second run changes nothing.
Rewritten split_into_halves(Graph graph, const std::vector<ObjectBounds>& bounds);

} // namespace graftal
