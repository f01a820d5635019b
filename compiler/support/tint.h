#pragma once

#include <glm/vec3.hpp>

namespace graftal {

using Rgb = glm::dvec3; ///< linear light, components in [0, 1]

/// The tint of one instance as a model writes it: a straight colour and the share it covers
/// (Hart 1992, section 5). Alpha 0 leaves what is below unchanged.
struct Tint {
    Rgb rgb{0.0};
    double alpha = 0;

    bool operator==(const Tint&) const = default;
};

/// The tints of a path composed, colour premultiplied: a monoid (Hart 1992, eq. (9) and (10), with C_i =
/// alpha_i c_i). Tints nearer to the root stay in front.
struct PathTint {
    Rgb premultiplied{0.0};
    double alpha = 0;

    PathTint() = default;
    PathTint(Rgb c, double a) : premultiplied(c), alpha(a) {}
    explicit PathTint(const Tint& tint) : premultiplied(tint.alpha * tint.rgb), alpha(tint.alpha) {}

    /// The colour seen where the path ends on an opaque surface of colour `base`.
    Rgb over(Rgb base) const { return premultiplied + (1 - alpha) * base; }
    bool operator==(const PathTint&) const = default;
};

/// Parent in front of child; associative, with the identity PathTint().
inline PathTint operator*(const PathTint& parent, const PathTint& child) {
    const double through = 1 - parent.alpha;
    return {parent.premultiplied + through * child.premultiplied, parent.alpha + through * child.alpha};
}

} // namespace graftal
