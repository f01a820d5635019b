#pragma once

#include <numbers>

#include <glm/vec2.hpp>

namespace graftal {

using Vec2 = glm::dvec2; ///< x and z of a place on the ground

/// A rectangle along the axes, or a disc, of the plane of x and z.
struct FlatArea {
    bool disc = false;
    Vec2 low{0.0}, high{0.0}; ///< the smallest and largest x and z
    Vec2 centre{0.0};
    double radius = 0; ///< of a disc

    bool operator==(const FlatArea&) const = default;

    static FlatArea rectangle(Vec2 low, Vec2 high) { return {false, low, high, 0.5 * low + 0.5 * high, 0}; }
    static FlatArea round(Vec2 centre, double radius) {
        return {true, centre - radius, centre + radius, centre, radius};
    }

    /// The border belongs to it.
    bool contains(Vec2 p) const {
        const Vec2 d = p - centre;
        if (disc) return d.x * d.x + d.y * d.y <= radius * radius;
        return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y;
    }

    /// Infinite where doubles do not hold it, 0 where it is empty.
    double size() const {
        const Vec2 d = high - low;
        return disc ? std::numbers::pi * radius * radius : d.x * d.y;
    }
};

} // namespace graftal
