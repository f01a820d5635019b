#include "compiler/povray/run_placements.h"

namespace graftal {

std::uint64_t part_count(const RunPlacements& parts) {
    std::uint64_t count = 0;
    for_each_part(parts, [&](RunShape, const RunItem&, bool) { ++count; });
    return count;
}

} // namespace graftal
