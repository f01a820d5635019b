#pragma once

#include <array>
#include <memory>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Bounds of an object's limit set while they are computed: it lies in an ellipsoid and in a box, and holds
/// some points (to rounding).
struct Outer {
    Vec3 centre{0.0};
    Mat3 reach{
        0.0}; ///< the ellipsoid is centre + reach^T (unit ball): its support is <d, centre> + |reach d|
    Box box;
    std::array<Vec3, 7> points;
    int point_count = 0;
    std::shared_ptr<const RunBounds> run; ///< of a run, whose support function it gives
    bool empty = true;                    ///< nothing but planes, or not computed yet

    /// At least the support function of the set.
    double above(Vec3 direction) const;
    /// The known point farthest along `direction`.
    Vec3 farthest_point(Vec3 direction) const;
    void set_ball(const Ball& ball);
    /// A ball that holds the ellipsoid.
    Ball ball() const;
};

using Outers = std::vector<Outer>; ///< by object

/// Lengths beyond this are taken for it; their squares are still numbers.
inline constexpr double largest_length = 1e140;

/// `value`, brought into the range of lengths; NaN becomes `largest_length`.
double within_range(double value);

/// The ball about a box.
Ball circumball(const Box& box);

} // namespace graftal
