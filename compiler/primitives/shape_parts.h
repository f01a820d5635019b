#pragma once

// Parts that primitives with shapes share.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "compiler/primitives/area_sampler.h"
#include "compiler/primitives/primitive.h"

namespace graftal {

/// `polygon(0, 0, 1, 0, 0, 1)`: the kind with its numbers, as `.inst` writes it.
std::string shape_name(PrimitiveKind kind, std::span<const double> numbers);

/// The shape of a primitive. Requires that the kind has this class of shapes.
template<typename Form> const Form& shape_of(const Primitive& primitive) {
    return static_cast<const Form&>(*primitive.shape());
}

using Triangle = std::array<Vec3, 3>;

/// Twice the area, along the normal.
Vec3 area_normal(const Triangle& triangle);

/// The point of the triangle that two numbers of [0, 1) choose evenly.
Vec3 point_of(const Triangle& triangle, double u, double v);

/// A ball about the middle of the points' box; its radius is less than a quarter too large.
Ball ball_about(std::span<const Vec3> points);
Box box_about(std::span<const Vec3> points);
Vec3 farthest_of(std::span<const Vec3> points, Vec3 direction);

} // namespace graftal
