#pragma once

#include "compiler/unfolded/scene.h"

namespace graftal {

/// Makes one mesh of the triangles that a node itself places in one look and one plane, and that have sides
/// in common, as those of a turtle's polygon have: a leaf is then one mesh. Triangles under pictures stay
/// apart, since each shows the picture in its own way, and so do those of nodes with more than 10,000. Nodes
/// keep their numbers, and those that nobody places any more leave masters_first. Requires resolved looks.
void unite_facets(UnfoldedScene& scene);

} // namespace graftal
