#pragma once

#include <functional>
#include <optional>

#include "runtime/inverse/lsystem/unfolding.h"

namespace graftal {

inline constexpr double seconds_of_unfolded_module = 2.5e-8; ///< the price of the meter

/// The smallest system found that draws the graph; nothing if none is. It depends on the graph and the work
/// allowed alone. `on_progress` hears of the share of the growths that were tried in a round.
std::optional<FoundGrammar> find_grammar(const StrokeGraph& graph, WorkMeter& meter,
                                         const std::function<void(double share, int round)>& on_progress);

} // namespace graftal
