#include "compiler/lsys/width.h"

#include <algorithm>

#include "compiler/support/number_range.h"

namespace graftal {

namespace {

constexpr double thinnest_in_segments = 0.1;
constexpr double thickest_in_segments = 0.8;
constexpr double line_in_figure = 1.0 / 400;
constexpr double trunk_in_figure = 1.0 / 220; ///< where twigs are finer
constexpr double plant_taper = 0.85;

/// Whether segments have other lengths than one step.
bool has_lengths(const LsysGrammar& grammar) {
    const auto has_length = [&](const LsysTemplate& module) {
        const TurtleCommand command = grammar.commands[module.symbol];
        return (command == TurtleCommand::draw || command == TurtleCommand::draw_unrecorded ||
                command == TurtleCommand::draw_always) &&
               !module.parameters.empty();
    };
    return grammar.uses({TurtleCommand::scale_by, TurtleCommand::scale_down_by, TurtleCommand::step_by}) ||
           std::ranges::any_of(grammar.axiom, has_length) ||
           std::ranges::any_of(grammar.rules, [&](const LsysRule& rule) {
               return std::ranges::any_of(rule.successor, has_length);
           });
}

} // namespace

bool draws_lines(const LsysGrammar& grammar) {
    return !grammar.width && !grammar.thickness &&
           !grammar.uses({TurtleCommand::width, TurtleCommand::width_by});
}

double branch_taper(const LsysGrammar& grammar) {
    if (grammar.taper) return *grammar.taper;
    const auto opens = [&](const LsysTemplate& module) {
        return grammar.commands[module.symbol] == TurtleCommand::open_branch;
    };
    const bool is_plant =
        draws_lines(grammar) && !has_lengths(grammar) && grammar.uses({TurtleCommand::open_branch}) &&
        !grammar.uses({TurtleCommand::open_polygon}) && std::ranges::none_of(grammar.axiom, opens);
    return is_plant ? plant_taper : 1;
}

bool has_open_width(const LsysGrammar& grammar) {
    return !grammar.width && !grammar.thickness && (draws_lines(grammar) || has_lengths(grammar));
}

double stated_width(const LsysGrammar& grammar) {
    if (grammar.thickness) return *grammar.thickness;
    return at_least_size(grammar.width.value_or(thinnest_in_segments * grammar.step));
}

double width_for(const LsysGrammar& grammar, const LengthTally& lengths, double reach) {
    const double least = thinnest_in_segments * lengths.median();
    const double most = thickest_in_segments * lengths.longest();
    const double in_figure = branch_taper(grammar) < 1 ? trunk_in_figure : line_in_figure;
    return at_least_size(draws_lines(grammar) ? std::clamp(in_figure * reach, least, most)
                                              : thinnest_in_segments * lengths.longest());
}

} // namespace graftal
