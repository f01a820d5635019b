#pragma once

#include <cstdint>

#include "compiler/povray/cut_parts.h"

namespace graftal {

/// Memory of POV-Ray 3.7, in bytes: measured on scenes of 60,000 placements and 200,000 triangles of each
/// kind (docs/benchmarks/memory.md).
struct PovrayCosts {
    static constexpr double base = 17.6e6;
    static constexpr double pixel = 19.5;
    static constexpr double placement = 931;   ///< of a mesh, in a union of one texture
    static constexpr double own_texture = 690; ///< more, for a placement that shares its texture with none
    static constexpr double own_layer = 740;   ///< more still, for a tint in front of a palette
    static constexpr double triangle = 207;
    static constexpr double vertex = 18;
    static constexpr double normal = 12; ///< one a vertex, of a smooth mesh
    static constexpr double uv = 16;     ///< one a vertex, of a mesh with a picture
    static constexpr double slot = 8;    ///< one colour of a palette

    static constexpr double least_placement = 336;
    static constexpr double matrix = 545; ///< of a primitive that cannot be written without one
};

/// Bytes of SDL, which take most of the time to write and to parse: measured on the tetrahedron of
/// docs/benchmarks/giants.md, normals on balls.
struct SdlLengths {
    static constexpr double placement = 131;   ///< of a mesh, with its matrix
    static constexpr double own_texture = 130; ///< more, for a palette and a tint in front of it
    static constexpr double triangle = 47;     ///< its corners' numbers, and half a vertex
    static constexpr double normal = 18;       ///< half of one
    static constexpr double slot = 27;         ///< its corners' numbers in a palette
};

/// About, of a leaf that nobody has placed yet: balls and cubes become ellipsoids and slabs more often than
/// not, which need a matrix.
double povray_leaf_bytes(const Primitive& primitive);

double povray_bytes(const Mesh& mesh);

/// POV-Ray's peak for this scene, the picture aside.
double povray_bytes(const Cut& cut);

} // namespace graftal
