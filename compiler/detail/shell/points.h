#pragma once

#include <cstdint>

#include "compiler/detail/shell/point_set.h"

namespace graftal {

/// Draws a node as points, cells of the side 1 / `detail_per_unit` apart, or more where the limits do not
/// suffice. The work grows with the number of cells that are met and not with the number of parts that lie in
/// them: each node has one grid, as fine as its finest use asks for, and each point of a grid is moved once
/// through every edge that leads to the grid's node. (The deterministic algorithm for an IFS on a grid, S.
/// Dubuc and A. Elqortobi, "Approximations of fractal sets", 1990, on a graph.) Every point that is kept is a
/// point of the set. A point of the set lies within a few cells of one that is kept: at most sqrt(3) cells
/// for each level, less by the contraction of the levels above. Where the set encloses space, what cannot be
/// seen from outside is left out. No points if there is no such grid, or if the node is unbounded.
/// Deterministic.
PointSet point_set(const DetailGraph& cut, NodeId node, std::uint32_t steps, double detail_per_unit,
                   const PointLimits& limits);

} // namespace graftal
