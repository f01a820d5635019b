#pragma once

#include "compiler/support/affine.h"

namespace graftal {

/// The normal of a set that has none: J. Hart and T. DeFanti ("Efficient Antialiased Rendering of 3-D Linear
/// Fractals", 1991) take it from the balls that bound the parts on the way to a point. Here the drawn part
/// counts by its own normal, and each unending node above it by the place of the point in its ball,
///     n = n_0 + sum_k ratio^-k (p - c_k) / r_k,
/// k = 1 being the nearest. Parts smaller than a pixel then show the relief of larger ones, in place of the
/// noise of their own surface. Weights fall fast enough that meshes, which know only the levels inside
/// them, and the tracer, which knows all, come to nearly the same.
inline constexpr double limit_normal_ratio = 1.5;
inline constexpr int limit_normal_levels = 6;

/// The sum over the balls, which is linear in the point: spread p - offset.
struct NormalField {
    double spread = 0;
    Vec3 offset{0.0};

    Vec3 at(Vec3 point) const { return spread * point - offset; }

    /// Adds the ball of level k >= 1.
    void add(int level, Vec3 centre, double radius);
    /// The field in a frame that is only scaled and moved: parent_from_child(x) = scale x + shift.
    NormalField seen_from(double scale, Vec3 shift) const;
};

} // namespace graftal
