#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/bounds.h"
#include "compiler/support/tint.h"

namespace graftal {

/// A triangle mesh in its own frame, coordinates of order 1. Colours are not part of it: mirror images that
/// differ in colour alone share a mesh. Each triangle names a slot of the palette that its group brings.
struct Mesh {
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals; ///< empty: flat; else one a vertex, of unit length
    /// Places on a texture, one a vertex (texture_space.h). Such a mesh has one slot, which does not count.
    std::vector<std::array<double, 2>> uv;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> slot_of_triangle; ///< empty if slot_count == 1
    std::uint32_t slot_count = 1;
};

/// In the mesh's own frame.
Box box_of(const Mesh& mesh);

/// Opaque colours, linear: one for each slot of the meshes that it is used with, or one for all slots (and
/// for primitives).
using Palette = std::vector<Rgb>;

} // namespace graftal
