#include "compiler/detail/mesh/slot_table.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace graftal {

void SlotTable::reserve(std::size_t leaves) {
    slot_of_leaf_.reserve(leaves);
    slot_ids_.reserve(leaves);
    for (Palette& palette : palettes_)
        palette.reserve(leaves);
}

void SlotTable::add(std::span<const Rgb> colours) {
    std::uint64_t hash = 0;
    for (const Rgb& rgb : colours)
        for (int k = 0; k < 3; ++k)
            hash = mixed(hash, std::bit_cast<std::uint64_t>(rgb[k]));
    const std::uint32_t next = slot_count();
    const std::uint32_t slot = slot_ids_.find_or_add(hash, next, [&](std::uint32_t other) {
        for (std::size_t painter = 0; painter < colours.size(); ++painter)
            if (palettes_[painter][other] != colours[painter]) return false;
        return true;
    });
    slot_of_leaf_.push_back(slot);
    if (slot < next) return;
    for (std::size_t painter = 0; painter < colours.size(); ++painter)
        palettes_[painter].push_back(colours[painter]);
}

std::vector<Palette> SlotTable::take_palettes() {
    for (Palette& palette : palettes_)
        if (std::all_of(palette.begin(), palette.end(), [&](const Rgb& rgb) { return rgb == palette[0]; }))
            palette.resize(1);
    return std::move(palettes_);
}

} // namespace graftal
