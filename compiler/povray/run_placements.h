#pragma once

// Parts of a run (graph/run.h) that are placed one by one, as they lie there: a Placement of each would take
// three times the memory of the run.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/run.h"

namespace graftal {

/// The parts of one colour of a range of a run.
struct RunPlacements {
    std::shared_ptr<const Run> run;
    std::size_t first = 0, count = 0; ///< items
    std::uint16_t colour = 0;
    Affine world_from_run;
    std::array<std::uint32_t, RunShape::count> body{}; ///< by RunShape::index()
    /// True for bodies and balls of the range's items, in turn, that are drawn elsewhere or not in sight.
    /// Null if none are.
    std::shared_ptr<const std::vector<bool>> left_out;
};

/// Calls `visit(shape, item, ball)` on each part, bodies before their balls.
template<typename Visit> void for_each_part(const RunPlacements& parts, const Visit& visit) {
    const auto left_out = [&](std::size_t i) { return parts.left_out && (*parts.left_out)[i]; };
    for (std::size_t i = 0; i < parts.count; ++i) {
        const RunItem& item = (*parts.run)[parts.first + i];
        if (item.colour != parts.colour) continue;
        if (!left_out(2 * i)) visit(item.shape, item, false);
        if (item.ball && !left_out(2 * i + 1)) visit(RunShape(PrimitiveKind::sphere), item, true);
    }
}

/// Number of parts.
std::uint64_t part_count(const RunPlacements& parts);

} // namespace graftal
