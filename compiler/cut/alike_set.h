#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "compiler/support/affine.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// Recognises parts that lie as another did that was met: where thousands of a set without area lie in each
/// other, one of those that nobody can tell apart will do. Keeps hashes of 64 bits, not the places.
class AlikeSet {
  public:
    /// Whether to go on with the part. `what`: parts of other kinds are never alike. `place`: in units of a
    /// cell, to which it is rounded. `scale`: its size. A part is left out for one that is no larger, and so
    /// never for one that it is a part of itself, which would be drawn without it.
    bool insert(std::uint64_t what, const Affine& place, double scale) {
        std::uint64_t hash = what;
        for (const Vec3& cells : {place.linear[0], place.linear[1], place.linear[2], place.translation})
            for (int row = 0; row < 3; ++row)
                hash = mixed(hash, std::bit_cast<std::uint64_t>(std::round(cells[row]) + 0.0)); // no minus 0
        const auto [least, added] = least_scale_.try_emplace(hash, scale);
        if (added) return true;
        if (!(scale < least->second)) return false;
        least->second = scale;
        return true;
    }

    bool empty() const { return least_scale_.empty(); }
    void clear() { least_scale_.clear(); }

  private:
    std::unordered_map<std::uint64_t, double> least_scale_; ///< by hash
};

/// What of a node with so many steps left is alike.
inline std::uint64_t alike_kind(std::uint32_t node, std::uint32_t steps, bool faint) {
    return mixed(std::uint64_t{node} * 2 + faint, steps);
}

} // namespace graftal
