#pragma once

#include <span>

#include "runtime/inverse/refine.h"

namespace graftal {

/// Random steps from one system of maps to another, large and small.
class MapSteps {
  public:
    MapSteps(const Target& target, const MapRules& rules, std::size_t most_maps)
        : target_(target), rules_(rules), most_maps_(most_maps) {}

    /// Moves a map or two, adds one at a missed point, splits one, or drops one. The maps keep the rules, and
    /// are at least one and at most `most_maps`.
    void step(PlaneMaps& maps, std::span<const Vec2> missed, Draws& draws) const;

  private:
    void shake(PlaneMap& map, Draws& draws) const;
    void stretch(PlaneMap& map, Draws& draws) const;
    void turn(PlaneMap& map, Draws& draws) const;
    void add(PlaneMaps& maps, const PlaneMap& map, Draws& draws) const;
    void split(PlaneMaps& maps, std::size_t which, Draws& draws) const;
    PlaneMap fresh(const PlaneMaps& maps, std::span<const Vec2> missed, Draws& draws) const;
    PlaneMap placed(const PlaneStretch& stretch, Vec2 image) const;

    const Target& target_;
    MapRules rules_;
    std::size_t most_maps_;
};

} // namespace graftal
