#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// Recognises parts that lie as another did that was met: where thousands of a set without area lie in each
/// other, one of those that nobody can tell apart is enough. Keeps hashes of 64 bits, not the places.
class AlikeSet {
  public:
    /// Whether to go on with the part. `what`: parts of other kinds are never alike. `place`: in units of a
    /// cell, to which it is rounded. `scale`: its size, finite. A part is left out for one that is no
    /// larger. So it is never left out for its own whole, which would be drawn without it.
    bool insert(std::uint64_t what, const Affine& place, double scale) {
        std::uint64_t hash = what;
        for (const Vec3& cells : {place.linear[0], place.linear[1], place.linear[2], place.translation})
            for (int row = 0; row < 3; ++row)
                hash = mixed(hash, cell_of(cells[row]));
        if (4 * (size_ + 1) > 3 * slots_.size()) grow();
        Slot& slot = slots_[place_of(hash)];
        const bool added = slot.least_scale == unused;
        if (!added && !(scale < slot.least_scale)) return false;
        slot = {hash, scale};
        size_ += added;
        return true;
    }

    bool empty() const { return size_ == 0; }
    void clear() {
        slots_ = {};
        size_ = 0;
    }

  private:
    static constexpr double unused = std::numeric_limits<double>::infinity();
    struct Slot {
        std::uint64_t hash = 0;
        double least_scale = unused;
    };

    /// Numbers beyond those of cells agree only if their bits do.
    static std::uint64_t cell_of(double place) {
        if (!(std::abs(place) < 9e18)) return std::bit_cast<std::uint64_t>(place);
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(place + std::copysign(0.5, place)));
    }

    /// Where the hash is, or where there is room for it. The upper half of a hash depends on all that it is
    /// made of.
    std::size_t place_of(std::uint64_t hash) const {
        std::size_t at = (hash >> 32) & (slots_.size() - 1);
        while (slots_[at].least_scale != unused && slots_[at].hash != hash)
            at = (at + 1) & (slots_.size() - 1);
        return at;
    }

    void grow() {
        constexpr std::size_t least = 64;
        std::vector<Slot> before(slots_.empty() ? least : 2 * slots_.size());
        before.swap(slots_);
        for (const Slot& slot : before)
            if (slot.least_scale != unused) slots_[place_of(slot.hash)] = slot;
    }

    std::vector<Slot> slots_; ///< a power of two of them
    std::size_t size_ = 0;
};

/// Key of the parts that are alike: those of one node with as many steps left.
inline std::uint64_t alike_kind(std::uint32_t node, std::uint32_t steps, bool faint) {
    return mixed(std::uint64_t{node} * 2 + faint, steps);
}

} // namespace graftal
