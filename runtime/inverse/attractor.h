#pragma once

#include <cstdint>
#include <vector>

#include "runtime/inverse/target.h"

namespace graftal {

/// How well an attractor's cells agree with the target's. Tolerant: a cell counts as found where the other
/// set has a cell among its neighbours, eight in the plane and 26 in space.
struct SetAgreement {
    double strict = 0;   ///< |A n T| / |A u T|
    double tolerant = 0; ///< the same, with the mean of both counts of found cells for |A n T|
    double chamfer =
        0; ///< mean distance from A to T, plus that from T to A, in cells; of agreement_in_full()
};

/// Draws attractors on the grid of a target. It keeps its memory between drawings.
template<typename Map> class AttractorPainterOf {
  public:
    using Point = typename Map::Point;

    /// `parts`: of a cell's side, a power of two. With more of them, fewer cells are missed that the
    /// attractor hardly touches.
    explicit AttractorPainterOf(const TargetOf<Map>& target, std::uint32_t parts = 2);

    /// Draws the attractor of contractions: every point that is kept is one of the attractor, and its images
    /// are drawn in turn, one for each part of a cell. Returns the maps that were applied.
    std::uint64_t draw(const std::vector<Map>& maps);

    /// SetAgreement of the drawn attractor, without the Chamfer distance.
    SetAgreement agreement() const;
    SetAgreement agreement_in_full() const;
    /// Whether the attractor has a cell here or among the neighbours.
    bool reaches(Point point) const;
    const std::vector<std::uint32_t>& cells() const { return cells_; }

  private:
    const TargetOf<Map>& target_;
    std::uint32_t parts_;
    CellLattice<Point> part_grid_;
    std::vector<std::ptrdiff_t> neighbours_;
    std::vector<std::uint8_t> drawn_, drawn_parts_;
    std::vector<std::uint32_t> cells_, touched_;
    std::vector<Point> queue_;
    std::size_t outside_ = 0; ///< images beyond the grid
};

using AttractorPainter = AttractorPainterOf<PlaneMap>;

/// The Hausdorff distance of the target from the union of its images, each moved to its nearest cell: epsilon
/// of the collage theorem (Barnsley 1985), in cells.
template<typename Map> double collage_distance(const TargetOf<Map>& target, const std::vector<Map>& maps);

} // namespace graftal
