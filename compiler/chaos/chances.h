#pragma once

#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Chances, by object and by instance, that a random walk down from the object takes the instance. They add
/// up to 1. All are 0 for an object that has nothing to take points of (planes only).
using Chances = std::vector<std::vector<double>>;

/// The chances that the instances state; else by size, so that points lie evenly:
///
/// - What ends is a surface, and gets points by its area; instances on the way by |det|^(2/3) times the size
/// of
///   what they place: |ad - bc| of a flat map.
/// - The limit set of a cycle gets points by the measure that its maps multiply by |det|^(2t/3), with the t
/// for
///   which it is invariant (the spectral radius of [|det|^(2t/3)] is 1): of an ordinary IFS p_j =
///   |det_j|^(2t/3). Among similarities that meet at most in edges this is the even measure, of exponent 2t =
///   dimension.
/// - A map that flattens gets a hundredth of what the largest of its component has.
/// - A cycle that draws something at every level gets points by area, if the areas of the levels add up to
///   something; they are made to, by the choice of t, if a level has more than 0.95 of the area of the one
///   before.
///
/// Requires the bounds of all objects. O(graph), plus a few dozen rounds through each cyclic component.
Chances chances_of(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds);

/// The sizes of objects, in units of area, by which chances_of() deals points out.
std::vector<double> sizes_of(const Graph& graph, const Components& components,
                             const std::vector<ObjectBounds>& bounds);
/// The size of a part that a map places, from sizes_of().
double placed_size(const Graph& graph, ObjectId part, const Affine& map, const std::vector<double>& sizes);

/// |det|^(2/3), the area-like size of a map of space; for flat rows of codes |ad - bc|.
double area_factor(const Mat3& linear);

} // namespace graftal
