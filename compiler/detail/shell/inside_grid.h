#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "compiler/support/control.h"

namespace graftal {

/// Cells of a cubic grid about the origin that no eye outside can see into, behind a set of points.
class InsideGrid {
  public:
    /// `cell`: side of one. `reach`: how many there are from the origin to either side. `hidden`: by cell, x
    /// first.
    InsideGrid(double cell, std::int64_t reach, std::vector<bool> hidden)
        : cell_(cell), reach_(reach), hidden_(std::move(hidden)) {}

    /// Whether the point lies in such a cell. False beyond the grid.
    bool has(const std::array<float, 3>& point) const;
    std::size_t bytes() const { return hidden_.size() / 8; }

  private:
    double cell_;
    std::int64_t reach_;
    std::vector<bool> hidden_;
};

/// Floods a grid of cells of the side `cell` from outside. Cells with points keep the flood out, and so do
/// those that are `known` to be inside, if any are. What lies a cell behind all that the flood wets is
/// inside. Null if nothing is, or if the grid would have too few cells across for that, or too many in all.
/// `work` grows by what the flood costs, in moves of a point (points.h); null, too, where it would pass
/// `most_work`. The flag ends it by Cancelled.
std::shared_ptr<const InsideGrid> find_inside(const std::vector<std::array<float, 3>>& points, double cell,
                                              const InsideGrid* known, std::uint64_t& work,
                                              std::uint64_t most_work = UINT64_MAX,
                                              const CancelFlag& cancel = {});

} // namespace graftal
