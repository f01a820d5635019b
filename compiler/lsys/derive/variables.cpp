#include "compiler/lsys/derive/variables.h"

#include <algorithm>

#include <fmt/format.h>

namespace graftal {

namespace {

/// The blocks of a step each have random numbers of their own.
constexpr std::uint64_t parts_of_step = 4;
/// The random sequence of a seed that is for the variables.
constexpr std::uint64_t of_variables = UINT64_MAX - 2;

} // namespace

LsysVariables::LsysVariables(const LsysGrammar& grammar, LsysMachine& machine, Diagnostics& diagnostics,
                             std::uint64_t seed)
    : grammar_(grammar), machine_(machine), diagnostics_(diagnostics),
      random_(CounterRandom(seed).sequence(of_variables)), now_(grammar.first_cells),
      slots_(step_slots.size() + grammar.step_draws) {}

bool LsysVariables::run(const LsysProgram& program, unsigned step, std::uint64_t part) {
    if (program.empty()) return true;
    LsysChance chance(random_.sequence(parts_of_step * step + part));
    slots_[0] = step;
    return machine_.run(program, {slots_, step_slots, now_, now_, &chance});
}

bool LsysVariables::start() {
    now_ = grammar_.first_cells;
    return run(grammar_.start, 0, 0);
}

bool LsysVariables::start_each(unsigned step) {
    return run(grammar_.start_each, step, 1);
}

bool LsysVariables::end_each(unsigned step) {
    return run(grammar_.end_each, step, 2);
}

bool LsysVariables::end(unsigned steps) {
    return run(grammar_.end, steps, 3);
}

bool LsysVariables::record(unsigned steps) {
    recorded_.reset();
    rows_.clear();
    during_.clear();
    after_.clear();
    if (!start() || !keep(during_) || !keep(after_)) return false;
    for (unsigned step = 1; step <= steps; ++step) {
        if (!start_each(step) || !keep(during_) || !end_each(step)) return false;
        if (step == steps && !end(steps)) return false;
        if (!keep(after_)) return false;
    }
    recorded_ = steps;
    return true;
}

/// Most steps change nothing, or little.
bool LsysVariables::keep(std::vector<std::uint32_t>& rows) {
    if (rows_.empty() || rows_.back() != now_) {
        if (now_.size() * (rows_.size() + 1) > max_recorded_cells) {
            diagnostics_
                .error(grammar_.source->name.span,
                       fmt::format("the variables have more than {} values in all steps", max_recorded_cells))
                .with_hint("use fewer steps, or smaller arrays");
            return false;
        }
        rows_.push_back(now_);
    }
    rows.push_back(static_cast<std::uint32_t>(rows_.size() - 1));
    return true;
}

std::span<const double> LsysVariables::row(const std::vector<std::uint32_t>& rows, unsigned step) const {
    return rows_[rows[std::min<std::size_t>(step, rows.size() - 1)]];
}

} // namespace graftal
