#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// A cell of space, by whole numbers.
using GridCell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const GridCell& cell) const {
        std::uint64_t hash = 0;
        for (const std::int64_t k : cell)
            hash = mixed(hash, static_cast<std::uint64_t>(k));
        return static_cast<std::size_t>(hash);
    }
};

/// The cell of this size that holds a place; requires a positive size. Cells beyond 1e15 are one.
inline GridCell cell_of(Vec3 place, double size) {
    GridCell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double farthest = 1e15;
        const double k = std::floor(place[axis] / size);
        cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(k > farthest    ? farthest
                                                                         : k < -farthest ? -farthest
                                                                                         : k);
    }
    return cell;
}

/// Things by the cells that they lie in, in each in the order in which they came.
class CellGrid {
  public:
    /// Requires a positive size.
    explicit CellGrid(double size) : size_(size) {}

    void add(Vec3 place, std::uint32_t thing) { cells_[cell_of(place, size_)].push_back(thing); }

    /// Calls look(thing) for all within `size` of a place, and for some others, until it says false.
    template<typename Look> void near(Vec3 place, const Look& look) const {
        const GridCell middle = cell_of(place, size_);
        look_between({middle[0] - 1, middle[1] - 1, middle[2] - 1},
                     {middle[0] + 1, middle[1] + 1, middle[2] + 1}, look);
    }

    /// Calls look(thing) for all within a distance along each axis, and some others, until it says false.
    template<typename Look> void near(Vec3 place, double distance, const Look& look) const {
        look_between(cell_of(place - distance, size_), cell_of(place + distance, size_), look);
    }

  private:
    template<typename Look>
    void look_between(const GridCell& first, const GridCell& last, const Look& look) const {
        for (std::int64_t x = first[0]; x <= last[0]; ++x)
            for (std::int64_t y = first[1]; y <= last[1]; ++y)
                for (std::int64_t z = first[2]; z <= last[2]; ++z) {
                    const auto cell = cells_.find({x, y, z});
                    if (cell == cells_.end()) continue;
                    for (const std::uint32_t thing : cell->second)
                        if (!look(thing)) return;
                }
    }

    double size_;
    std::unordered_map<GridCell, std::vector<std::uint32_t>, CellHash> cells_;
};

} // namespace graftal
