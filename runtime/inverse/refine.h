#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/inverse/target.h"

namespace graftal {

/// Limits on the maps that the search makes.
struct MapRules {
    /// The longest that a map may make a unit vector. Every map that the search makes keeps to it, so the
    /// system contracts.
    double most_stretch = 0.93;
    bool similar = false; ///< only similarities
};

/// The map with the rules kept; the image of the target's centre stays.
PlaneMap ruled(const PlaneMap& map, const Target& target, const MapRules& rules);

/// Points that stand for the target while maps are refined.
struct FitPoints {
    std::vector<Vec2> inner; ///< whose images are to lie in the target
    std::vector<Vec2> outer; ///< that images are to come near
};

/// Grows a map w until the target holds no larger image of itself thereabouts: Levenberg and Marquardt's
/// method (Marquardt 1963) on mean |w p - T|^2 / tau^2 - mu log |det w|, for each length tau in turn. Returns
/// the work: maps applied to points.
std::uint64_t grow(const Target& target, std::span<const Vec2> inner, std::span<const double> tau_px,
                   int iterations, const MapRules& rules, PlaneMap& map);

struct LevelFit {
    int levels = 1; ///< words of so many maps are compared
    int iterations = 12;
    double reach_px = 4; ///< points farther away count for little (Geman and McClure 1987)
};

inline constexpr int most_levels = 6;

/// Refines maps w_i so that the union of the images of T under all words of `levels` maps comes near T, both
/// ways, by Levenberg and Marquardt's method. With one level that is the distance of Barnsley's collage
/// theorem (1985), with more it tends to the distance of the attractor itself. The word of a point is found
/// letter by letter, by the nearest image. Returns the work.
std::uint64_t refine(const Target& target, const FitPoints& points, const LevelFit& fit,
                     const MapRules& rules, Draws& draws, PlaneMaps& maps);

} // namespace graftal
