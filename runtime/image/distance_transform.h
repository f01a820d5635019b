#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace graftal {

/// Cells of a grid that belong to a set; cell (x, y) stands for its middle. In space, the cells are cubes.
struct CellSet {
    int width = 0;
    int height = 0;
    int depth = 1; ///< in the plane: 1
    std::vector<bool> cells;

    CellSet(int w, int h, int d = 1)
        : width(w), height(h), depth(d),
          cells(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(d),
                false) {}
    std::size_t index(int x, int y, int z = 0) const {
        const auto row =
            static_cast<std::size_t>(z) * static_cast<std::size_t>(height) + static_cast<std::size_t>(y);
        return row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    bool at(int x, int y, int z = 0) const { return cells[index(x, y, z)]; }
};

/// For every cell the squared distance to the nearest cell of the set, exact (Felzenszwalb and Huttenlocher
/// 2012: lower envelopes of parabolas, row by row after column by column, and in space at last front to
/// back). O(cells). Requires a set that is not empty.
std::vector<std::int64_t> squared_distances(const CellSet& set);

/// For every cell the index of a nearest cell of the set, by squared_distances() and at its price. Requires a
/// set that is not empty.
std::vector<std::size_t> nearest_cells(const CellSet& set);

/// The largest distance of a cell of `from` from the nearest of the set that these are the squared distances
/// to.
double farthest(const CellSet& from, const std::vector<std::int64_t>& squared);

/// The Hausdorff distance of two sets of one grid, neither of them empty, in cells.
double hausdorff_distance(const CellSet& a, const CellSet& b);

} // namespace graftal
