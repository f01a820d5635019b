#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/support/counter_random.h"
#include "compiler/support/flat_area.h"

namespace graftal {

/// Random numbers of one task, one after the other.
class Draws : public RandomStream {
  public:
    Draws(CounterRandom random, std::uint64_t number) : RandomStream(random.sequence(number)) {}
    double normal(); ///< of mean 0 and deviation 1 (Box and Muller 1958)
};

/// The map x' = a x + b y + e, y' = c x + d y + f: a row of `codes 2d`. The search is one text for this and
/// for SpaceMap (space_map.h), which offers the same.
struct PlaneMap {
    using Point = Vec2;
    static constexpr std::size_t dimensions = 2;
    static constexpr std::size_t entries = 6; ///< of a step of moved()
    static constexpr std::size_t similar_entries = 4;

    double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;

    Vec2 operator()(Vec2 p) const { return {a * p.x + b * p.y + e, c * p.x + d * p.y + f}; }
    double determinant() const { return a * d - b * c; }
    /// The image of p under the transposed linear part.
    Vec2 transposed(Vec2 p) const { return {a * p.x + c * p.y, b * p.x + d * p.y}; }
    /// The map with this linear part that takes `from` to `to`.
    PlaneMap taking(Vec2 from, Vec2 to) const;
    /// The slope of log |det| by the entries of a step. A determinant nearer to 0 counts as 1e-7.
    std::array<double, entries> log_slope() const;
    /// The steps by which a similarity stays one, to first order.
    std::array<std::array<double, entries>, similar_entries> similar_steps() const;
    /// Halves all lengths.
    static PlaneMap half() { return {0.5, 0, 0, 0.5, 0, 0}; }
    /// A linear contraction to begin with. `missed`: for a part that other maps missed, which may be small or
    /// thin.
    static PlaneMap random(bool missed, bool similar, Draws& draws);
    bool operator==(const PlaneMap&) const = default;
};

using PlaneMaps = std::vector<PlaneMap>;

/// The linear part as rotation(left_rad) * diagonal(largest, least) * rotation(right_rad). `least` is
/// negative where the map mirrors; |least| <= largest.
struct PlaneStretch {
    double largest = 0, least = 0, left_rad = 0, right_rad = 0;
};

PlaneStretch stretch_of(const PlaneMap& map);

/// The map with this linear part that takes `from` to `to`.
PlaneMap map_of(const PlaneStretch& stretch, Vec2 from, Vec2 to);

/// The longest that a map makes a unit vector: the contractivity, where it is below 1.
double largest_stretch(const PlaneMaps& maps);

/// Moves the map by `step`, the changes of a, b, the image's x, c, d and the image's y at `centre`. Where it
/// then lengthens more than `most`, its stretches are cut to that; the image of `centre` stays.
PlaneMap moved(const PlaneMap& map, const double* step, Vec2 centre, double most);

/// The nearest map that changes no shape, by the least sum of squares of the linear part; the image of
/// `centre` stays.
PlaneMap nearest_similarity(const PlaneMap& map, Vec2 centre);

/// An inverse of bounded length: stretches below `least` count as that, so that a flat map has one, too.
PlaneMap bounded_inverse(const PlaneMap& map, Vec2 centre, double least);

/// The point that the map leaves in place. Requires a contraction.
Vec2 fixed_point(const PlaneMap& map);

} // namespace graftal
