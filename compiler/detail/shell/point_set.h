#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/shell/inside_grid.h"
#include "compiler/support/control.h"

namespace graftal {

/// Look of a point; the path ends on the colour that the node inherits.
struct PointPaint : Paint {
    std::int32_t material = -1; ///< none: the one that the node inherits

    Rgb over(Rgb inherited) const {
        return Rgb(fixed[0], fixed[1], fixed[2]) + static_cast<double>(open) * inherited;
    }
    /// Seen from one edge higher.
    PointPaint above(const LookStep& step) const;
};

/// Most cells of a shell's surface, about; one that would have more is coarser.
inline constexpr double most_shell_cells = 7e5;

/// Limits of the work on points, and of their number.
struct PointLimits {
    std::uint64_t work = 300'000'000; ///< in all: points moved and sampled, cells flooded
    std::size_t points = 8'000'000;   ///< kept at once, of all nodes
    CancelFlag cancel{};              ///< ends it by Cancelled
};

/// Points of what a node draws, at most one in each cell of a grid.
struct PointSet {
    double cell = 0;                          ///< side of a cell, in the node's units
    Vec3 middle{0.0};                         ///< where the grid's coordinates are 0
    bool flat = false;                        ///< all points lie in z = middle.z
    std::vector<std::array<float, 3>> points; ///< from the middle, in the node's units
    std::vector<PointPaint> paints;           ///< by point; empty: all plain
    std::shared_ptr<const InsideGrid> inside; ///< cells that no eye outside can see; null: none
    std::uint64_t work = 0;                   ///< cost, also where nothing came of it
    /// Range of sides of cells for which the points are the same: where the limits decide, there is no finer
    /// one.
    double finest_asked = 0, coarsest_asked = 0;

    /// Whether the point (from the middle) is well inside.
    bool is_inside(const std::array<float, 3>& point) const { return inside && inside->has(point); }
};

} // namespace graftal
