#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace graftal {

/// Finds things by their hash, things that lie in a vector of the user's: the table itself keeps nothing but
/// their numbers there and half of their hashes, so that much of it fits into a cache.
class IdTable {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// The number of the thing of this hash for which `same(number)` holds; if there is none, `next`, which
    /// is then in the table.
    template<typename Same>
    std::uint32_t find_or_add(std::uint64_t hash, std::uint32_t next, const Same& same) {
        if (4 * (size_ + 1) > 3 * slots_.size()) grow(2 * slots_.size());
        const auto mark = static_cast<std::uint32_t>(hash >> 32);
        for (std::size_t at = mark & mask_;; at = (at + 1) & mask_) {
            Slot& slot = slots_[at];
            if (slot.id == none) {
                slot = {mark, next};
                ++size_;
                return next;
            }
            if (slot.mark == mark && same(slot.id)) return slot.id;
        }
    }

    /// The number of the thing of this hash for which `same(number)` holds; `none` if there is none.
    template<typename Same> std::uint32_t find(std::uint64_t hash, const Same& same) const {
        if (slots_.empty()) return none;
        const auto mark = static_cast<std::uint32_t>(hash >> 32);
        for (std::size_t at = mark & mask_;; at = (at + 1) & mask_) {
            const Slot& slot = slots_[at];
            if (slot.id == none || (slot.mark == mark && same(slot.id))) return slot.id;
        }
    }

    /// Adds a thing, whether or not there is one like it.
    void add(std::uint64_t hash, std::uint32_t id) {
        find_or_add(hash, id, [](std::uint32_t) { return false; });
    }

    /// Makes room for `count` entries.
    void reserve(std::size_t count);
    /// Forgets all, but keeps its room.
    void clear();

  private:
    struct Slot {
        std::uint32_t mark = 0;
        std::uint32_t id = none;
    };

    void grow(std::size_t least);

    std::vector<Slot> slots_; ///< a power of two of them
    std::size_t mask_ = 0;
    std::size_t size_ = 0;
};

/// A hash for find_or_add(): the upper half depends on all bits of all values.
inline std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
    hash = (hash ^ value) * 0x9E3779B97F4A7C15ull;
    return hash ^ (hash >> 32);
}

} // namespace graftal
