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
struct SelfCopy {
    PlaneMap map;
    double bad = 0; ///< share of the image that lies outside
    SampleSet covered;
    std::size_t count = 0; ///< of covered samples
};

/// The samples within `reach_px` of the map's image of the target.
SampleSet covered_by(const PlaneMap& map, const Target& target, double reach_px = 1.2);

/// A search for copies: points of the target that are looked at, coarse and fine.
class CopySearch {
  public:
    CopySearch(const Target& target, const MapRules& rules);

    /// A random map, grown; nothing where it came to nothing. `where`: a point that the image is to have;
    /// null: any point of the target.
    std::optional<SelfCopy> find(Draws& draws, std::uint64_t& work, const Vec2* where = nullptr) const;

    /// The copy that random steps from a map climb to: towards images that lie in the target and reach as
    /// many of the `wanted` points as they can; none wanted: points of the target's edge. Nothing where there
    /// is none.
    std::optional<SelfCopy> climb(const PlaneMap& map, std::span<const Vec2> wanted, Draws& draws,
                                  std::uint64_t& work) const;

  private:
    /// The map, moved so that edges of the image and of the target coincide.
    std::optional<SelfCopy> snapped(const PlaneMap& map, double reach_px, Draws& draws,
                                    std::uint64_t& work) const;
    double merit(const PlaneMap& map, std::span<const Vec2> wanted, double reach_px,
                 std::uint64_t& work) const;
    double outside(const PlaneMap& map, std::span<const Vec2> points, double& mean_px) const;

    const Target& target_;
    MapRules rules_;
    std::vector<Vec2> coarse_;
    FitPoints points_;
};

/// The best of the copies, without those that repeat a better one.
std::vector<SelfCopy> distinct(std::vector<SelfCopy> copies, const Target& target, std::size_t most);

/// Sets of copies that together cover the target with few maps, best first, by beam search.
std::vector<PlaneMaps> covers(const std::vector<SelfCopy>& copies, const Target& target,
                              std::size_t most_maps, std::size_t most_covers);

} // namespace graftal
