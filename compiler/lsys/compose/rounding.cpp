#include "compiler/lsys/compose/rounding.h"

namespace graftal {

bool has_sizes(const LsysGrammar& grammar, const LsysSizes& sizes) {
    if (grammar.uses({TurtleCommand::widen})) return false; // a sum of widths goes with no size
    return sizes.any() ||
           grammar.uses({TurtleCommand::scale_by, TurtleCommand::scale_down_by, TurtleCommand::step_by});
}

bool uses_directions(const LsysGrammar& grammar) {
    return grammar.uses({TurtleCommand::level, TurtleCommand::tropism, TurtleCommand::stiffen,
                         TurtleCommand::set_tropism, TurtleCommand::bend_down});
}

std::deque<Rounding> roundings_of(const LsysGrammar& grammar, const LsysSizes& sizes) {
    std::deque<Rounding> roundings(1);
    const bool resizes = has_sizes(grammar, sizes);
    if (resizes) {
        roundings.push_back({.resizes = true});
        for (const double step : {1.0 / 64, 1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 1.0})
            roundings.push_back({.resizes = true, .size_step = step});
    }
    if (uses_directions(grammar))
        for (const double angle_deg : {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0})
            roundings.push_back({resizes, resizes ? 1.0 / 16 : 0, angle_deg});
    return roundings;
}

} // namespace graftal
