#include "compiler/support/id_table.h"

#include <algorithm>
#include <bit>

namespace graftal {

void IdTable::clear() {
    std::fill(slots_.begin(), slots_.end(), Slot{});
    size_ = 0;
}

void IdTable::reserve(std::size_t count) {
    const std::size_t slots = count + count / 3 + 1;
    if (slots > slots_.size()) grow(slots);
}

void IdTable::grow(std::size_t least) {
    constexpr std::size_t fewest = 64;
    std::vector<Slot> old;
    old.swap(slots_);
    const std::size_t count = std::bit_ceil(std::max(fewest, least));
    slots_.reserve(count);
    slots_.resize(count);
    mask_ = slots_.size() - 1;
    for (const Slot& slot : old) {
        if (slot.id == none) continue;
        std::size_t at = slot.mark & mask_;
        while (slots_[at].id != none)
            at = (at + 1) & mask_;
        slots_[at] = slot;
    }
}

} // namespace graftal
