#pragma once

#include "runtime/inverse/search.h"

namespace graftal {

/// Parts of a cell's side, a power of two, by which search_occupancy() tells in the end which cells an
/// attractor has.
std::uint32_t occupancy_parts(const Target& target);

/// Searches as search() does, for a system whose attractor has the same cells as the target: neighbours do
/// not count for them. A share of the work goes into search(). The rest goes into simulated annealing
/// (Kirkpatrick, Gelatt and Vecchi 1983) of the number of cells that only one of both has, by chains that
/// begin with one map. The better of both is annealed once more, on finer parts of cells.
FoundSystem search_occupancy(const Target& target, const SearchOptions& options, const Workers& workers,
                             const CancelFlag& cancel,
                             const std::function<void(const SearchProgress&)>& on_progress);

} // namespace graftal
