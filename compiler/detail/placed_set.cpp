#include "compiler/detail/placed_set.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace graftal {

PlacedSet::PlacedSet(double size, std::size_t expected) : unit_(1e-9 * std::max(size, 1e-280)) {
    digests_.reserve(expected);
    ids_.reserve(expected);
}

void PlacedSet::extend(Digest& digest, double value) const {
    // Cells of what is larger than 2^63 units agree only if the bits do.
    const double cells = value / unit_;
    const std::uint64_t cell =
        std::abs(cells) < 9e18
            ? static_cast<std::uint64_t>(static_cast<std::int64_t>(cells + std::copysign(0.5, cells)))
            : std::bit_cast<std::uint64_t>(value);
    auto& [low, high] = digest;
    low = (low ^ cell) * 0x9E3779B97F4A7C15ull;
    low ^= low >> 32;
    high = (high + std::rotl(cell, 29)) * 0xD6E8FEB86659FD93ull;
    high ^= high >> 29;
}

bool PlacedSet::insert(std::uint32_t thing, const Affine& place) {
    if (thing != last_thing_ || place.linear != last_linear_) {
        last_thing_ = thing;
        last_linear_ = place.linear;
        last_digest_ = {0x243F6A8885A308D3ull, thing};
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                extend(last_digest_, place.linear[column][row]);
    }
    Digest digest = last_digest_;
    for (int row = 0; row < 3; ++row)
        extend(digest, place.translation[row]);
    const auto next = static_cast<std::uint32_t>(digests_.size());
    const std::uint32_t id =
        ids_.find_or_add(digest[0], next, [&](std::uint32_t other) { return digests_[other] == digest; });
    if (id < next) return false;
    digests_.push_back(digest);
    return true;
}

} // namespace graftal
