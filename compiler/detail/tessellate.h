#pragma once

// Canonical primitives as triangle meshes, so that they can be baked together with their neighbours.

#include <array>
#include <cstdint>
#include <vector>

#include "compiler/graph/graph.h"

namespace graftal {

/// A canonical primitive (graph.h) as a mesh in the primitive's own frame. Closed surfaces are watertight
/// (positions of vertices that are doubled for their normals agree to the last bit) and no triangle is
/// degenerate; corners run counter-clockwise seen from outside, those of the triangle seen from +z.
struct TessellatedPrimitive {
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals; ///< one a vertex, of unit length; empty for triangle and cube, which are flat
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The finest mesh that there is: 6 for sphere (32,768 triangles) and torus (147,456), 8 for cylinder and
/// cone (768 sides), 0 for triangle and cube. Requires another kind than plane, as all below.
int max_fineness(PrimitiveKind kind);

/// The mesh with 2^fineness times the segments of the coarsest: an octahedron, prisms and pyramids of three
/// sides, a ring of 6 by 3. Flat sides lie half inside and half outside of the curved surface; those of a
/// sphere so that its mean shadow is the sphere's, a handful of pixels though it be. Opposite faces of the
/// cube are cut alike, so that stacked cubes share whole triangles. Cached; safe to call from many threads.
/// Requires 0 <= fineness <= max_fineness(kind).
const TessellatedPrimitive& tessellated(PrimitiveKind kind, int fineness);

/// The largest distance between the surface and that mesh, either way, in canonical units; 0 if it is exact.
double tessellation_error(PrimitiveKind kind, int fineness);

/// The least fineness whose error is at most `tolerance`, or max_fineness(kind) if none is.
int fineness_for(PrimitiveKind kind, double tolerance);

} // namespace graftal
