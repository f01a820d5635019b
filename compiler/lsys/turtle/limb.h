#pragma once

#include <cstdint>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// A point of a limb's axis, and the radius there.
struct LimbNode {
    Vec3 place{0.0};
    double radius = 0;
};

/// A chain of segments that gets one skin.
struct Limb {
    /// The thing that the first node stands on.
    enum class Base : std::uint8_t {
        nothing, ///< the end is flat
        entry,   ///< whatever limb came in where the part begins, and goes on
        limb,    ///< another limb, in which the end is sunk
    };

    Base base = Base::nothing;
    Vec3 base_place{0.0};   ///< on the axis of the other limb,
    double base_radius = 0; ///< with the radius of that,
    Vec3 base_way{0.0};     ///< and its direction
    int colour = 0;
    Span span;                   ///< of its first segment
    std::vector<LimbNode> nodes; ///< none, or two and more
};

} // namespace graftal
