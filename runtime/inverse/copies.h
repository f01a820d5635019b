#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/inverse/refine.h"

namespace graftal {

/// A bit for each of the target's samples.
using SampleSet = std::vector<std::uint64_t>;

std::size_t count_of(const SampleSet& set);

/// A map that takes the target nearly into itself, and the samples that the image comes to.
template<typename Map> struct SelfCopy {
    Map map;
    double bad = 0; ///< share of the image that lies outside
    SampleSet covered;
    std::size_t count = 0; ///< of covered samples
};

/// The samples within `reach_px` of the map's image of the target.
template<typename Map>
SampleSet covered_by(const Map& map, const TargetOf<Map>& target, double reach_px = 1.2);

/// A search for copies: points of the target that are looked at, coarse and fine.
template<typename Map> class CopySearch {
  public:
    using Point = typename Map::Point;

    CopySearch(const TargetOf<Map>& target, const MapRules& rules);

    /// A random map, grown; nothing where it came to nothing. `where`: a point that the image is to have;
    /// null: any point of the target.
    std::optional<SelfCopy<Map>> find(Draws& draws, std::uint64_t& work, const Point* where = nullptr) const;

    /// The copy that random steps from a map climb to: towards images that lie in the target and reach as
    /// many of the `wanted` points as they can; none wanted: points of the target's edge. Nothing where there
    /// is none.
    std::optional<SelfCopy<Map>> climb(const Map& map, std::span<const Point> wanted, Draws& draws,
                                       std::uint64_t& work) const;

  private:
    /// The most promising of random maps.
    Map first_map(Draws& draws, std::uint64_t& work, const Point* where) const;
    /// The map, moved so that edges of the image and of the target coincide.
    std::optional<SelfCopy<Map>> snapped(const Map& map, double reach_px, Draws& draws,
                                         std::uint64_t& work) const;
    double merit(const Map& map, std::span<const Point> wanted, double reach_px, std::uint64_t& work) const;
    double outside(const Map& map, std::span<const Point> points, double& mean_px) const;

    const TargetOf<Map>& target_;
    MapRules rules_;
    std::vector<Point> coarse_;
    FitPoints<Point> points_;
};

/// The best of the copies, without those that repeat a better one.
template<typename Map>
std::vector<SelfCopy<Map>> distinct(std::vector<SelfCopy<Map>> copies, const TargetOf<Map>& target,
                                    std::size_t most);

/// Sets of copies that together cover the target with few maps, best first, by beam search.
template<typename Map>
std::vector<std::vector<Map>> covers(const std::vector<SelfCopy<Map>>& copies, const TargetOf<Map>& target,
                                     std::size_t most_maps, std::size_t most_covers);

} // namespace graftal
