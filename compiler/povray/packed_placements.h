#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/graph/packed_edges.h"
#include "compiler/graph/run.h"

namespace graftal {

struct Placement {
    std::uint32_t body = 0;
    Affine world_from_body;
};

/// Placements of the parts of one colour of a range of packed edges, each made where it is looked at: all of
/// them would take three times the memory of the run.
struct PackedPlacements {
    std::shared_ptr<const Run> run;
    std::size_t first = 0, count = 0; ///< items
    std::uint16_t colour = 0;
    Affine world_from_run;
    std::array<std::uint32_t, RunShape::count> body{}; ///< by RunShape::index()
    /// True for bodies and balls of the range's items, in turn, that are drawn elsewhere or not in sight.
    /// Null if none are.
    std::shared_ptr<const std::vector<bool>> left_out;

    std::uint64_t size() const {
        std::uint64_t parts = 0;
        for_each_part([&](RunShape, const RunItem&, bool) { ++parts; });
        return parts;
    }

    /// Calls `visit` on each Placement, bodies before their balls.
    template<typename Visit> void for_each(const Visit& visit) const {
        for_each_part([&](RunShape shape, const RunItem& item, bool ball) {
            const Affine run_from_part = ball ? run_from_round_ball(item) : run_from_round_body(item);
            visit(Placement{body[shape.index()], world_from_run * run_from_part});
        });
    }

  private:
    template<typename Visit> void for_each_part(const Visit& visit) const {
        const auto is_left_out = [&](std::size_t part) { return left_out && (*left_out)[part]; };
        for (std::size_t i = 0; i < count; ++i) {
            const RunItem& item = (*run)[first + i];
            if (item.colour != colour) continue;
            if (!is_left_out(2 * i)) visit(item.shape, item, false);
            if (item.ball && !is_left_out(2 * i + 1)) visit(RunShape(PrimitiveKind::sphere), item, true);
        }
    }
};

} // namespace graftal
