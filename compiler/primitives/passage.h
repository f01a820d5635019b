#pragma once

// A convex solid is met as an intersection of simpler ones: the part of the ray within a quadric is cut to
// the part between two planes. Met each for itself, a side and its cap would leave a crack where both just
// miss.
//
// Quadrics are solved from the ray's point nearest to their centre (the sphere's), axis (the cylinder's) or
// apex (the cone's), not from its origin. This is the geometric form of the discriminant, which keeps its
// digits however far away the origin is, and at the apex: Haines, Guenther and Akenine-Moeller, "Precision
// improvements for ray/sphere intersection", Ray Tracing Gems, 2019, chapter 7.

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/support/ray.h"

namespace graftal {

/// A ray that approaches a plane by less for each unit of its way counts as parallel to it.
inline constexpr double parallel_to_plane = 1e-20;
/// A ray parallel to a plane may lie this far outside, and one through a flat shape may pass this far beyond
/// an edge: where two shapes touch it belongs to both, not to none. Their maps may place the edge
/// differently, by the rounding of each level above them. No picture shows so little of a shape of size 1.
inline constexpr double passage_rounding = 1e-10;

/// The part of a ray within a convex solid, its ends included; empty if it enters after it leaves.
struct Passage {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
};
inline constexpr Passage no_passage{std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity()};

inline Passage both(const Passage& a, const Passage& b) {
    return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
}

inline Passage between(double least, double most, double origin, double direction) {
    if (std::abs(direction) < parallel_to_plane)
        return origin >= least - passage_rounding && origin <= most + passage_rounding ? Passage{}
                                                                                       : no_passage;
    const double inverse = 1 / direction;
    const double a = (least - origin) * inverse, b = (most - origin) * inverse;
    return {std::min(a, b), std::max(a, b)};
}

/// An end of a passage: where the ray enters the solid or, seen from inside, leaves it.
struct PassageEnd {
    double t;
    bool leaving;

    double of(const Passage& passage) const { return leaving ? passage.leave : passage.enter; }
    /// The direction, of a coordinate, that leads outwards where the ray crosses a plane.
    double outwards(double direction) const { return std::copysign(1.0, leaving ? direction : -direction); }
};

inline bool holds(const RayRange& range, double t) {
    return t > range.least && t < range.most;
}

inline bool first_end(const Passage& passage, const RayRange& range, PassageEnd& end) {
    if (!(passage.enter <= passage.leave)) return false;
    end.leaving = !(passage.enter > range.least);
    end.t = end.of(passage);
    return holds(range, end.t);
}

} // namespace graftal
