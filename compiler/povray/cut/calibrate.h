#pragma once

#include <cstdint>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/symmetry.h"

namespace graftal {

/// Number of a cube's 12 triangles that stay visible, on average, where cubes are baked together: measured
/// on a piece of some thousand cubes. 12 if the graph bakes no cubes, or none that is soon baked. `visits`:
/// of nodes and leaves, the cost of this.
double visible_cube_triangles(const DetailGraph& cut, const Symmetry& symmetry, std::uint32_t steps,
                              std::uint64_t* visits = nullptr);

} // namespace graftal
