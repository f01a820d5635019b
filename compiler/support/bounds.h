#pragma once

#include <array>
#include <limits>

#include "compiler/support/affine.h"

namespace graftal {

/// Axis-aligned box; the default one is empty (min > max).
struct Box {
    Vec3 min{std::numeric_limits<double>::infinity()};
    Vec3 max{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    Vec3 centre() const { return 0.5 * (min + max); }
    Vec3 size() const { return max - min; }
    std::array<Vec3, 8> corners() const;
    void include(Vec3 point);
    void include(const Box& other);
    bool operator==(const Box&) const = default;
};

/// Closed ball; a negative radius is empty.
struct Ball {
    Vec3 centre{0.0};
    double radius = -1;

    bool empty() const { return radius < 0; }
    bool operator==(const Ball&) const = default;
};

/// The box of the image of a box (exact for the box, not for what was inside it).
Box transformed(const Affine& a, const Box& box);

/// A ball that holds the image of a ball: radius times the largest stretch.
Ball transformed(const Affine& a, const Ball& ball);

} // namespace graftal
