#include "compiler/chaos/alias_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compiler/support/check.h"

namespace graftal {

namespace {

std::uint32_t heaviest(const std::vector<double>& weights) {
    return static_cast<std::uint32_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

} // namespace

AliasTables::Range AliasTables::add(const std::vector<double>& weights, std::uint32_t first_choice) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    GRAFTAL_CHECK(sum > 0 && std::isfinite(sum), "chances that sum to nothing");
    const Range range{static_cast<std::uint32_t>(entries_.size()),
                      static_cast<std::uint32_t>(weights.size())};
    std::vector<double> share; // of a slot: below 1 it has room for a part of another
    std::vector<std::uint32_t> poor, rich;
    for (std::uint32_t i = 0; i < range.count; ++i) {
        share.push_back(weights[i] * range.count / sum);
        entries_.push_back({UINT32_MAX, first_choice + i, first_choice + i});
        (share[i] < 1 ? poor : rich).push_back(i);
    }
    while (!poor.empty() && !rich.empty()) {
        const std::uint32_t taker = poor.back(), giver = rich.back();
        poor.pop_back();
        Entry& entry = entries_[range.first + taker];
        entry.own = static_cast<std::uint32_t>(std::min(share[taker] * 0x1p32, 0x1p32 - 1));
        entry.alias = first_choice + giver;
        share[giver] -= 1 - share[taker];
        if (share[giver] >= 1) continue;
        rich.pop_back();
        poor.push_back(giver);
    }
    // The remaining slots are full up to rounding, unless they have no weight at all.
    for (const std::uint32_t i : poor)
        if (weights[i] == 0)
            entries_[range.first + i].choice = entries_[range.first + i].alias =
                first_choice + heaviest(weights);
    return range;
}

} // namespace graftal
