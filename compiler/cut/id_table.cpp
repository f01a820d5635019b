#include "compiler/cut/id_table.h"

#include <algorithm>
#include <utility>

namespace graftal {

void IdTable::clear() {
    std::fill(slots_.begin(), slots_.end(), Slot{});
    size_ = 0;
}

void IdTable::grow() {
    constexpr std::size_t fewest = 64;
    std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(std::max(fewest, 2 * slots_.size())));
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
