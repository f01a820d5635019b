#pragma once

#include <array>

#include "compiler/graph/graph.h"

namespace graftal {

/// Where a picture is wrapped round a primitive: u to the right, v upwards, one picture from whole number to
/// whole number.
///   cylinder, cone, frustum   u round the y axis, v along it
///   sphere                    u round the y axis, v by latitude
///   torus                     u round the y axis, v round the tube
///   triangle                  the picture over the triangle's box
///   cube                      the picture over the faces before and behind, and through what is between
/// Planes are not textured.
struct TextureSpace {
    double around = 1; ///< pictures round what is round
    double along = 1;  ///< pictures along a cylinder, cone or frustum
};

/// The length of a cylinder placed by this map as a share of its circumference at y = 0. Of the instance's
/// own map: so that it is the same wherever what holds the instance is placed.
double length_in_turns(const Mat3& parent_from_primitive);

/// The space of a primitive of a material with this `around`. Pictures keep their proportions as nearly as
/// whole ones fit, so that they go on from one piece of a branch to the next.
TextureSpace texture_space(PrimitiveKind kind, double around, double turns);

using TexturePoint = std::array<double, 2>; ///< u, v

/// Of a point of the primitive's surface, in its own frame.
TexturePoint texture_coordinates(PrimitiveKind kind, const TextureSpace& space, Vec3 point);

/// Of three such points that are near each other, on one side of the seams.
std::array<TexturePoint, 3> texture_coordinates(PrimitiveKind kind, const TextureSpace& space,
                                                const std::array<Vec3, 3>& points);

} // namespace graftal
