#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/image/distance_transform.h"
#include "runtime/inverse/cell_lattice.h"
#include "runtime/inverse/space_map.h"

namespace graftal {

/// A set of cells, of the plane or of space, that an attractor is to equal, with what the search asks of it.
/// Lengths are in cells, and there is room around the set: half of its longest side, in space a quarter.
template<typename Map> class TargetOf {
  public:
    using Point = typename Map::Point;
    /// Lengths of the search, over those for sets of the plane, which have more cells a side.
    static constexpr double fineness = Map::dimensions == 2 ? 1 : 0.5;
    /// A point farther from the set counts as outside.
    static constexpr double beside = Map::dimensions == 2 ? 1.6 : 1.3;

    /// Requires a set that is not empty, and lies in the whole of `set`: no empty row or column at its
    /// border. In the plane, its depth is 1.
    explicit TargetOf(const CellSet& set);

    const CellLattice<Point>& grid() const { return grid_; } ///< with the room
    int width() const { return static_cast<int>(grid_.side(0)); }
    int height() const { return static_cast<int>(grid_.side(1)); }
    int room() const { return room_; }
    const std::vector<Point>& points() const { return points_; } ///< the middles of cells
    bool inside(std::size_t cell) const { return cells_.cells[cell]; }
    const CellSet& cells() const { return cells_; } ///< on the grid
    /// True for cells of the set and their neighbours, eight in the plane and 26 in space.
    bool near(std::size_t cell) const { return near_[cell] != 0; }
    Point centre() const { return centre_; }  ///< the mean of the points
    double spread() const { return spread_; } ///< their deviation from it
    std::span<const Point> samples() const { return samples_; }

    /// The point of the set that is nearest to the cell of `p`; a place outside the grid counts as the
    /// border.
    Point nearest(Point p) const { return CellLattice<Point>::middle(nearest_[grid_.clamped_index(p)]); }
    /// Random points: half of them from the edge of the set, which says most about maps.
    std::vector<Point> drawn(std::size_t count, Draws& draws) const;
    std::vector<Point> drawn_edge(std::size_t count, Draws& draws) const;

  private:
    int room_;
    CellSet cells_;
    CellLattice<Point> grid_;
    std::vector<Point> points_, edge_, samples_;
    std::vector<typename CellLattice<Point>::Place> nearest_; ///< of each cell
    std::vector<std::uint8_t> near_;
    Point centre_{0.0};
    double spread_ = 0;
};

using Target = TargetOf<PlaneMap>;
using SpaceTarget = TargetOf<SpaceMap>;

} // namespace graftal
