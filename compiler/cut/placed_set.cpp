#include "compiler/cut/placed_set.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace graftal {

PlacedSet::PlacedSet(double size, std::size_t expected) : unit_(1e-9 * std::max(size, 1e-280)) {
    seen_.reserve(expected);
}

bool PlacedSet::insert(std::uint32_t thing, const Affine& place) {
    std::uint64_t low = 0x243F6A8885A308D3ull, high = thing;
    const auto digest = [&](double value) {
        // Cells of what is larger than 2^63 units agree only if the bits do.
        const double cells = value / unit_;
        const std::uint64_t cell =
            std::abs(cells) < 9e18
                ? static_cast<std::uint64_t>(static_cast<std::int64_t>(cells + std::copysign(0.5, cells)))
                : std::bit_cast<std::uint64_t>(value);
        low = (low ^ cell) * 0x9E3779B97F4A7C15ull;
        low ^= low >> 32;
        high = (high + std::rotl(cell, 29)) * 0xD6E8FEB86659FD93ull;
        high ^= high >> 29;
    };
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            digest(place.linear[column][row]);
    for (int row = 0; row < 3; ++row)
        digest(place.translation[row]);
    return seen_.insert({low, high}).second;
}

} // namespace graftal
