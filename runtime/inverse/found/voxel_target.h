#pragma once

#include <optional>
#include <string>

#include "compiler/primitives/mesh_file.h"
#include "runtime/image/distance_transform.h"

namespace graftal {

/// The cells of space that a cloud of points or the surface of a mesh has, in the box around it.
struct VoxelTarget {
    CellSet cells{0, 0, 0};
    Vec3 corner{0.0};    ///< the lowest of cell (0, 0, 0)
    double cell = 1;     ///< its side, in units of the file
    std::size_t set = 0; ///< cells of the set
};

/// Reads cells off a file's data: all triangles, or the vertices where there are none. The longest side of
/// the box has 64 cells or fewer, down to 16: so many that the set has no more than the search can do with,
/// and that each of its cells has four vertices of a cloud, on average. Nothing, and what is at fault, where
/// fewer than 24 cells come of it, or the triangles are too many and too large.
std::optional<VoxelTarget> voxels_of(const MeshData& data, std::string& fault);

} // namespace graftal
