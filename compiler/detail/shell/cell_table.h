#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace graftal {

/// A cell of a cubic grid by its place; requires places within `most` of the middle.
struct CellKey {
    static constexpr int bits = 21;
    static constexpr std::int64_t most = (1 << (bits - 1)) - 4;

    std::int64_t x = 0, y = 0, z = 0;

    std::uint64_t packed() const {
        constexpr std::int64_t half = 1 << (bits - 1);
        return static_cast<std::uint64_t>(x + half) | static_cast<std::uint64_t>(y + half) << bits |
               static_cast<std::uint64_t>(z + half) << (2 * bits);
    }
    static CellKey unpacked(std::uint64_t key) {
        constexpr std::int64_t half = 1 << (bits - 1), low = (1 << bits) - 1;
        const auto part = [&](int i) { return static_cast<std::int64_t>(key >> (i * bits)) & low; };
        return {part(0) - half, part(1) - half, part(2) - half};
    }
};

/// Numbers cells in the order in which they come. Who uses it keeps the cells, by number: the table itself
/// takes 11 to 21 bytes a cell.
class CellTable {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    CellTable() : slots_(16), mask_(15) {}

    /// The number of the cell; `next` if it was not there and has that number from now on. `packed_of(n)` is
    /// the cell that has the number n.
    template<typename PackedOf>
    std::uint32_t find_or_add(std::uint64_t packed, std::uint32_t next, const PackedOf& packed_of) {
        if (4 * (count_ + 1) > 3 * slots_.size()) grow();
        const std::uint64_t hash = hash_of(packed);
        std::size_t i = home(hash);
        for (; slots_[i].number != none; i = (i + 1) & mask_)
            if (slots_[i].tag == tag_of(hash) && packed_of(slots_[i].number) == packed)
                return slots_[i].number;
        slots_[i] = {tag_of(hash), next};
        ++count_;
        return next;
    }

    /// The number of the cell, or none.
    template<typename PackedOf> std::uint32_t find(std::uint64_t packed, const PackedOf& packed_of) const {
        const std::uint64_t hash = hash_of(packed);
        for (std::size_t i = home(hash); slots_[i].number != none; i = (i + 1) & mask_)
            if (slots_[i].tag == tag_of(hash) && packed_of(slots_[i].number) == packed)
                return slots_[i].number;
        return none;
    }

    void clear() { *this = CellTable(); }

  private:
    struct Slot {
        std::uint32_t tag = 0; ///< the home's upper bits: where the table grows, the homes grow by them
        std::uint32_t number = none;
    };

    static std::uint64_t hash_of(std::uint64_t packed) {
        packed *= 0x9E3779B97F4A7C15ull;
        return (packed ^ (packed >> 32)) * 0xD6E8FEB86659FD93ull;
    }
    static std::uint32_t tag_of(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32); }
    /// Slot by the tag alone, so that growing needs no cells. Requires fewer than 2^32 slots.
    std::size_t home(std::uint64_t hash) const { return tag_of(hash) & mask_; }

    void grow() {
        std::vector<Slot> before(2 * slots_.size());
        before.swap(slots_);
        mask_ = slots_.size() - 1;
        for (const Slot& slot : before) {
            if (slot.number == none) continue;
            std::size_t i = slot.tag & mask_;
            while (slots_[i].number != none)
                i = (i + 1) & mask_;
            slots_[i] = slot;
        }
    }

    std::vector<Slot> slots_;
    std::size_t mask_;
    std::size_t count_ = 0;
};

} // namespace graftal
