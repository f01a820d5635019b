#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/inverse/plane_map.h"
#include "runtime/points/distance_transform.h"

namespace graftal {

/// A set of cells that an attractor is to equal, with what the search asks of it. Lengths are in cells, and
/// there is room around the set: half of its longer side.
class Target {
  public:
    /// Requires a set that is not empty, and lies in the whole of `set`: no empty row or column at its
    /// border.
    explicit Target(const CellSet& set);

    int width() const { return grid_.width; } ///< with the room
    int height() const { return grid_.height; }
    int room() const { return room_; }
    const std::vector<Vec2>& points() const { return points_; } ///< the middles of cells
    bool inside(std::size_t cell) const { return grid_.cells[cell]; }
    /// True for cells of the set and their eight neighbours.
    bool near(std::size_t cell) const { return near_[cell] != 0; }
    Vec2 centre() const { return centre_; }   ///< the mean of the points
    double spread() const { return spread_; } ///< their deviation from it
    std::span<const Vec2> samples() const { return samples_; }

    /// The point of the set that is nearest to the cell of `p`; a place outside the grid counts as the
    /// border.
    Vec2 nearest(Vec2 p) const {
        const int x = p.x < 0 ? 0 : p.x < last_x_ ? static_cast<int>(p.x) : grid_.width - 1;
        const int y = p.y < 0 ? 0 : p.y < last_y_ ? static_cast<int>(p.y) : grid_.height - 1;
        return nearest_[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width) +
                        static_cast<std::size_t>(x)];
    }
    /// Random points: half of them from the edge of the set, which says most about maps.
    std::vector<Vec2> drawn(std::size_t count, Draws& draws) const;
    std::vector<Vec2> drawn_edge(std::size_t count, Draws& draws) const;

  private:
    CellSet grid_;
    int room_;
    double last_x_, last_y_;
    std::vector<Vec2> points_, edge_, samples_;
    std::vector<Vec2> nearest_; ///< of each cell
    std::vector<std::uint8_t> near_;
    Vec2 centre_{0.0};
    double spread_ = 0;
};

} // namespace graftal
