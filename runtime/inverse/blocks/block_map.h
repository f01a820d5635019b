#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace graftal {

// Block coding (Jacquin 1992; the quadtree is Fisher's, 1995). A plane of grey levels, from 0 to 255, is cut
// into square range blocks. The map of each fills it from a domain block, which is twice as wide, anywhere in
// the plane: four pixels of the domain are averaged to one, and a grey map is applied,
//     W(f)(p) = slope (A f(p) - 127.5) + level.
// The plane is stored as the maps alone. Averages and isometries do not enlarge a difference, so
//     sup |W(f) - W(g)| <= s sup |f - g|, where s is the largest |slope|, at most 7/8.
// So W contracts, and has one fixed point, to which iteration converges from any plane (Banach). By the
// collage theorem that is at most sup |f - W(f)| / (1 - s) from f.

/// Sides of range blocks: powers of two.
inline constexpr int least_side = 4, largest_side = 32, range_sides = 4;
/// Slopes are eighths.
inline constexpr int slope_steps = 8, largest_slope = 7;
inline constexpr int isometries = 8;
inline constexpr float middle_level = 127.5f;
/// Levels of grey maps with a slope: even numbers. Those of flat blocks are any from 0 to 255.
inline constexpr int lowest_level = -128, level_step = 2, level_count = 256;
inline constexpr int most_pool_bits = 16;
/// The longest side of a picture.
inline constexpr int most_picture_side = 32768;

/// A range block, and the map that fills it.
struct BlockMap {
    int x = 0, y = 0, side = 0;
    int slope = 0; ///< in eighths; 0: the block is flat, and has no domain
    int isometry = 0;
    std::uint32_t domain = 0; ///< in the pool of its side
    int level = 0;            ///< where the grey map takes 127.5

    bool operator==(const BlockMap&) const = default;
    float scale() const { return static_cast<float>(slope) / slope_steps; }
    float offset() const { return static_cast<float>(level) - scale() * middle_level; }
};

/// The size of a plane. Blocks cover it with a margin, up to a multiple of the least side.
struct PlaneGrid {
    int width = 0, height = 0;

    static int padded(int length) { return (length + least_side - 1) / least_side * least_side; }
    int padded_width() const { return padded(width); }
    int padded_height() const { return padded(height); }
    bool holds(int x, int y, int side) const {
        return x + side <= padded_width() && y + side <= padded_height();
    }
};

/// The domain blocks of one size: their corners lie on a lattice over the plane.
struct DomainPool {
    int side = 0; ///< of a domain
    int step = 1; ///< of the lattice
    int columns = 0, rows = 0;

    /// The finest lattice with at most 2^bits domains; none in a plane that is smaller than a domain.
    DomainPool(const PlaneGrid& grid, int range_side, int bits);

    std::uint32_t count() const {
        return static_cast<std::uint32_t>(columns) * static_cast<std::uint32_t>(rows);
    }
    int x(std::uint32_t domain) const {
        return static_cast<int>(domain % static_cast<std::uint32_t>(columns)) * step;
    }
    int y(std::uint32_t domain) const {
        return static_cast<int>(domain / static_cast<std::uint32_t>(columns)) * step;
    }
};

/// The place of a square block that an isometry takes to <u, v>: the first bit mirrors u, the second v, and
/// the third swaps them before. `last`: the largest coordinate.
template<typename Number> struct BlockPlace {
    Number u, v;
    BlockPlace under(int isometry, Number last) const {
        BlockPlace place = isometry & 4 ? BlockPlace{v, u} : *this;
        if (isometry & 1) place.u = last - place.u;
        if (isometry & 2) place.v = last - place.v;
        return place;
    }
};

/// The maps of a plane, in the order of walk_partition().
struct CodedPlane {
    PlaneGrid grid;
    int pool_bits = 0; ///< of the pools, in which each has at most 2^bits domains
    std::vector<BlockMap> blocks;
};

/// A picture as partitioned iterated function systems, one a plane.
struct BlockPicture {
    int width = 0, height = 0;
    bool colour = false; ///< planes: luma and two chromas of half the size, else grey
    bool alpha = false;  ///< the last plane
    std::vector<CodedPlane> planes;

    std::size_t plane_count() const { return (colour ? 3 : 1) + (alpha ? 1 : 0); }
    bool is_half(std::size_t plane) const { return colour && (plane == 1 || plane == 2); }
    PlaneGrid grid_of(std::size_t plane) const {
        return is_half(plane) ? PlaneGrid{(width + 1) / 2, (height + 1) / 2} : PlaneGrid{width, height};
    }
};

/// Walks the quadtree of a plane: squares of the largest side row by row, and their quarters. `divided` says
/// of a square (x, y, side) whether it is; it is not asked about the least ones, nor about those across the
/// border, which are divided. `leaf` gets the others.
template<typename Divided, typename Leaf> class PartitionWalk {
  public:
    PartitionWalk(const PlaneGrid& grid, Divided& divided, Leaf& leaf)
        : grid_(grid), divided_(divided), leaf_(leaf) {
        for (int y = 0; y < grid.height; y += largest_side)
            for (int x = 0; x < grid.width; x += largest_side)
                visit(x, y, largest_side);
    }

  private:
    void visit(int x, int y, int side) {
        if (x >= grid_.width || y >= grid_.height) return;
        if (side == least_side || (grid_.holds(x, y, side) && !divided_(x, y, side)))
            return leaf_(x, y, side);
        for (int quarter = 0; quarter < 4; ++quarter)
            visit(x + quarter % 2 * side / 2, y + quarter / 2 * side / 2, side / 2);
    }

    const PlaneGrid& grid_;
    Divided& divided_;
    Leaf& leaf_;
};

template<typename Divided, typename Leaf>
void walk_partition(const PlaneGrid& grid, Divided&& divided, Leaf&& leaf) {
    PartitionWalk<Divided, Leaf>(grid, divided, leaf);
}

} // namespace graftal
