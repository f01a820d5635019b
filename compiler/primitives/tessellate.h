#pragma once

// Canonical primitives as triangle meshes, so that they can be baked together with their neighbours.

#include "compiler/primitives/primitive.h"

namespace graftal {

/// No mesh is finer.
inline constexpr int finest_mesh = 8;

/// The finest mesh that there is: 6 for sphere (32,768 triangles) and torus (147,456), 8 for cylinder and
/// cone (768 sides), 0 for triangle and cube. Requires another kind than plane, as all below.
int max_fineness(const Primitive& primitive);

/// The mesh with 2^fineness times the segments of the coarsest: an octahedron, prisms and pyramids of three
/// sides, a ring of 6 by 3. Flat sides lie half inside and half outside of the curved surface; those of a
/// sphere so that its mean shadow is the sphere's, a handful of pixels though it be. Opposite faces of the
/// cube are cut alike, so that stacked cubes share whole triangles. Cached; safe to call from many threads.
/// Requires 0 <= fineness <= max_fineness(primitive).
const TessellatedPrimitive& tessellated(const Primitive& primitive, int fineness);

/// The largest distance between the surface and that mesh, either way, in canonical units; 0 if it is exact.
double tessellation_error(const Primitive& primitive, int fineness);

/// The least fineness whose error is at most `tolerance`, or max_fineness(primitive) if none is.
int fineness_for(const Primitive& primitive, double tolerance);

} // namespace graftal
