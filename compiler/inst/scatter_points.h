#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/flat_area.h"

namespace graftal {

/// Where places may lie: in one area, and in none of others.
struct ScatterArea {
    FlatArea within;
    std::vector<FlatArea> without;

    bool contains(Vec2 p) const;
    /// The size of `within` less `without`, by 256 times 256 samples, which a meter counts: exact where
    /// nothing is left out.
    double size(WorkMeter* meter = nullptr) const;
};

// Each gives as many places as it can, at most `count`, all inside `area`. Requires size() to be more than
// some hundredth of the whole, for the others are drawn in vain.
// They depend on these arguments alone (a meter counts the random numbers, and the areas that points are held
// against; null: nobody does). They are made by additions, multiplications and roots, which all machines
// round alike.

/// Places no nearer to each other than `apart` (> 0): darts, thrown until most of them miss. Then candidates
/// around every place fill the area (Bridson 2007, "Fast Poisson disk sampling in arbitrary dimensions").
std::vector<Vec2> poisson_points(const ScatterArea& area, std::size_t count, double apart,
                                 CounterRandom random, WorkMeter* meter = nullptr);

/// Each by itself: they gather in clumps.
std::vector<Vec2> uniform_points(const ScatterArea& area, std::size_t count, CounterRandom random,
                                 WorkMeter* meter = nullptr);

/// One somewhere in each cell of a lattice: even, with neither clumps nor a least distance.
std::vector<Vec2> jittered_points(const ScatterArea& area, std::size_t count, CounterRandom random,
                                  WorkMeter* meter = nullptr);

/// Places like the seeds of a sunflower (Vogel 1979), about the centre of the area.
std::vector<Vec2> spiral_points(const ScatterArea& area, std::size_t count, WorkMeter* meter = nullptr);

/// The distance at which `count` places fill the area loosely enough that darts find them soon: 0.7 of the
/// side of the square that each has. Darts alone get to 0.83, a triangular lattice to 1.07.
double loose_distance(double area_size, std::size_t count);

} // namespace graftal
