#pragma once

#include <cstdint>
#include <vector>

namespace graftal {

/// Many small tables of weighted choices in one array (Walker 1977): each choice takes one random number and
/// looks at one entry. Chances are kept to 2^-32.
class AliasTables {
  public:
    struct Range {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    /// A table for these weights, none of them negative and one at least positive; choices are the numbers
    /// `first_choice` and following.
    Range add(const std::vector<double>& weights, std::uint32_t first_choice = 0);

    /// One of the choices; `bits`: 64 random bits.
    std::uint32_t choose(Range range, std::uint64_t bits) const {
        const std::uint64_t slot = ((bits >> 32) * range.count) >> 32;
        const Entry& entry = entries_[range.first + slot];
        return static_cast<std::uint32_t>(bits) < entry.own ? entry.choice : entry.alias;
    }

    struct Entry {
        std::uint32_t own = UINT32_MAX; ///< share of the slot, in 2^-32, that is its own choice
        std::uint32_t choice = 0;
        std::uint32_t alias = 0;
    };
    const std::vector<Entry>& entries() const { return entries_; }

  private:
    std::vector<Entry> entries_;
};

} // namespace graftal
