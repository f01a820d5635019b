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
template<typename Map> Map ruled(const Map& map, const TargetOf<Map>& target, const MapRules& rules);

/// Points that stand for the target while maps are refined.
template<typename Point> struct FitPoints {
    std::vector<Point> inner; ///< whose images are to lie in the target
    std::vector<Point> outer; ///< that images are to come near
};

/// The points of a search, by the levels of the words that images are compared by: words of many maps cost
/// more, so that fewer points are inner ones.
template<typename Map> class LevelPoints {
  public:
    using Points = FitPoints<typename Map::Point>;

    LevelPoints(const TargetOf<Map>& target, std::uint64_t seed) {
        Draws draws(CounterRandom(seed), 0);
        one_.inner = target.drawn(200, draws);
        one_.outer = target.drawn(1000, draws);
        more_.inner.assign(one_.inner.begin(), one_.inner.begin() + 100);
        more_.outer = one_.outer;
    }

    const Points& of(int levels) const { return levels == 1 ? one_ : more_; }

  private:
    Points one_, more_;
};

/// Processor seconds of a map that is applied to a point, with the nearest cell of the target: the unit of
/// counted work.
inline constexpr double seconds_of_map = 1.8e-8;

/// Grows a map w until the target holds no larger image of itself thereabouts: Levenberg and Marquardt's
/// method (Marquardt 1963) on mean |w p - T|^2 / tau^2 - mu log |det w|, for each length tau in turn. Returns
/// the work: maps applied to points.
template<typename Map>
std::uint64_t grow(const TargetOf<Map>& target, std::span<const typename Map::Point> inner,
                   std::span<const double> tau_px, int iterations, const MapRules& rules, Map& map);

/// The value that grow() makes least, for one length tau.
template<typename Map>
double growth_value(const TargetOf<Map>& target, std::span<const typename Map::Point> inner, double tau_px,
                    const Map& map);

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
template<typename Map>
std::uint64_t refine(const TargetOf<Map>& target, const FitPoints<typename Map::Point>& points,
                     const LevelFit& fit, const MapRules& rules, Draws& draws, std::vector<Map>& maps);

} // namespace graftal
