#include "runtime/inverse/blocks/block_map.h"

namespace graftal {

DomainPool::DomainPool(const PlaneGrid& grid, int range_side, int bits) : side(2 * range_side) {
    const int width = grid.padded_width() - side, height = grid.padded_height() - side;
    if (width < 0 || height < 0) return;
    const auto fits = [&] {
        const std::int64_t count =
            (std::int64_t{width} / step + 1) * (std::int64_t{height} / step + 1); // of corners
        return count <= std::int64_t{1} << bits;
    };
    while (!fits())
        ++step;
    columns = width / step + 1;
    rows = height / step + 1;
}

} // namespace graftal
