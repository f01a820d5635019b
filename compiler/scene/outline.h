#pragma once

#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Points whose convex hull holds the limit set of the root (planes aside): the corners of the boxes of a
/// few thousand pieces that the root is unfolded into. The largest are unfolded first, then those that reach
/// farthest in the given directions. Much closer to what is seen than the root's own box, which a pound sign
/// or a tree leaves empty in its corners. Requires the bounds of all objects, the root's not empty.
std::vector<Vec3> outline(const Graph& graph, const std::vector<ObjectBounds>& bounds,
                          const std::vector<Vec3>& directions);

/// Points whose convex hull holds the object: a triangle's corners, else those of its box. None if that is
/// empty.
std::vector<Vec3> hull_points(const Object& object, const Box& box);

} // namespace graftal
