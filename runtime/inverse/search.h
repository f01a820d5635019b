#pragma once

#include <cstdint>
#include <functional>

#include "compiler/support/control.h"
#include "compiler/support/workers.h"
#include "runtime/inverse/attractor.h"
#include "runtime/inverse/refine.h"

namespace graftal {

template<typename Map> struct SearchOptionsOf {
    std::size_t most_maps = 8; ///< at least 2
    MapRules rules;
    double seconds = 30; ///< of one processor, by counted work
    std::uint64_t seed = 1;
    std::vector<Map> start; ///< to begin with, in cells of the target's grid; empty: nothing is known
};

struct SearchProgress {
    double fraction = 0; ///< of the work allowed
    double tolerant = 0; ///< agreement of the best system so far
    std::size_t maps = 0;
};

template<typename Map> struct FoundSystemOf {
    std::vector<Map> maps; ///< at least one
    SetAgreement agreement;
    double seconds = 0; ///< of counted work
};

using SearchOptions = SearchOptionsOf<PlaneMap>;
using FoundSystem = FoundSystemOf<PlaneMap>;

/// Searches for an iterated function system whose attractor equals the target. It depends on target and
/// options, not on the number of workers: work is counted, not timed. A raised flag ends it early, with the
/// best so far.
///
/// First, random maps grow into copies of the target within itself; a beam search covers the target by few of
/// them, and each cover is refined as a collage. Then rounds try to better the best systems: they drop a map,
/// or add one for a part that is missed, and refine all by words of several maps. At last random steps climb
/// the agreement itself.
template<typename Map>
FoundSystemOf<Map> search(const TargetOf<Map>& target, const SearchOptionsOf<Map>& options,
                          const Workers& workers, const CancelFlag& cancel,
                          const std::function<void(const SearchProgress&)>& on_progress);

} // namespace graftal
