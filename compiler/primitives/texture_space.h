#pragma once

// Where a picture is wrapped round a primitive: u to the right, v upwards, one picture from whole number to
// whole number. Each primitive's file says how (PrimitiveTraits::texture_point). Planes are not textured.

#include <array>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// The u of a point of what goes round the y axis, from +z to +x.
double turn_about_y(const TextureSpace& space, Vec3 point);

/// The length of a cylinder placed by this map as a share of its circumference at y = 0. The map is the
/// instance's own: the share is the same wherever the instance's holder is placed.
double length_in_turns(const Mat3& parent_from_primitive);

/// The space of a primitive of a material with this `around`. Pictures keep their proportions as nearly as
/// whole ones fit, so that they go on from one piece of a branch to the next.
TextureSpace texture_space(const Primitive& primitive, double around, double turns);

/// Whether its surface has texture points of its own, by its rows or from a file: nobody else could find them
/// from the points alone.
bool has_texture_points(const Primitive& primitive);

/// The texture point of a point of the primitive's surface, in its own frame.
TexturePoint texture_coordinates(const Primitive& primitive, const TextureSpace& space, Vec3 point);

/// The texture points of three points of the surface near each other, on one side of the seams.
std::array<TexturePoint, 3> texture_coordinates(const Primitive& primitive, const TextureSpace& space,
                                                const std::array<Vec3, 3>& points);

} // namespace graftal
