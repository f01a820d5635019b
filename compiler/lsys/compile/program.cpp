#include "compiler/lsys/compile/program.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

using Command = LsysCommand::Kind;
using Step = LsysInstruction::Kind;

/// Recursion is as deep as the braces, which the parser bounds.
class ProgramCompiler {
  public:
    ProgramCompiler(const LsysProgramNames& names, Diagnostics& diagnostics)
        : names_(names), diagnostics_(diagnostics) {}

    LsysProgram run(const LsysCommands& commands) && {
        add(commands.list);
        return std::move(program_);
    }

  private:
    void add(const std::vector<LsysCommand>& commands) {
        for (const LsysCommand& command : commands) {
            if (diagnostics_.full()) return;
            switch (command.kind) {
            case Command::assign:
                add_assignment(command);
                break;
            case Command::choose:
                add_choice(command);
                break;
            case Command::loop:
                add_loop(command);
                break;
            case Command::loop_after:
                add_loop_after(command);
                break;
            }
        }
    }

    std::uint32_t here() const { return static_cast<std::uint32_t>(program_.instructions.size()); }

    LsysInstruction& append(Step kind, const LsysCommand& source) {
        LsysInstruction& added = program_.instructions.emplace_back();
        added.kind = kind;
        added.source = &source;
        return added;
    }

    void formula(const Expression& expression, std::optional<LsysFormula>& result) {
        result = compile_formula(expression, names_, diagnostics_);
        if (!result) return;
        // Slots have their random numbers from the beginning, unless these are drawn anew.
        if (names_.draws_anew || loops_ > 0)
            program_.draws_anew |= result->draws > 0;
        else
            result->draws = 0;
    }

    void add_assignment(const LsysCommand& command) {
        const auto slot = std::ranges::find(names_.slots, command.target);
        const auto cell = names_.cells.find(command.target);
        if (slot != names_.slots.end()) {
            if (!command.indices.empty())
                return refuse(command, fmt::format("'{}' is a number, not an array", command.target));
            append(Step::set_slot, command).to = static_cast<std::uint32_t>(slot - names_.slots.begin());
        } else if (cell == names_.cells.end()) {
            return refuse_unknown(command);
        } else if (cell->second.dimensions != command.indices.size()) {
            return refuse_indices(command, cell->second);
        } else {
            LsysInstruction& added =
                append(command.indices.empty() ? Step::set_cell : Step::set_element, command);
            added.to = cell->second.first;
            added.array = cell->second;
            program_.sets_cells = true;
        }
        const std::size_t at = program_.instructions.size() - 1;
        for (const Expression& index : command.indices) {
            std::optional<LsysFormula> code;
            formula(index, code);
            if (code) program_.instructions[at].indices.push_back(std::move(*code));
        }
        formula(*command.value, program_.instructions[at].value);
    }

    void refuse(const LsysCommand& command, std::string message, std::string hint = {}) {
        Diagnostic& error = diagnostics_.error(command.span, std::move(message));
        if (!hint.empty()) error.with_hint(std::move(hint));
    }

    void refuse_unknown(const LsysCommand& command) {
        const std::string& name = command.target;
        if (name == "pi") return refuse(command, "'pi' is a constant and cannot be set");
        if (names_.lets.contains(name))
            return refuse(command, fmt::format("'{}' is a constant, which no block can change", name),
                          fmt::format("name it by 'variable {} = ...' in place of 'let'", name));
        if (!command.indices.empty())
            return refuse(command, fmt::format("unknown array '{}'", name), known(name));
        refuse(command, fmt::format("unknown variable '{}'", name),
               fmt::format("declare it: variable {} = 0; {}", name, known(name)));
    }

    std::string known(const std::string& name) const {
        std::vector<std::string> names;
        for (const auto& [variable, place] : names_.cells)
            names.push_back(variable);
        return names.empty() ? "the block has no variables" : choices(name, names);
    }

    void refuse_indices(const LsysCommand& command, const CellPlace& place) {
        if (place.dimensions == 0)
            return refuse(command, fmt::format("'{}' is a number, not an array", command.target));
        refuse(command,
               fmt::format("'{}' has {} ind{}, not {}", command.target, place.dimensions,
                           place.dimensions == 1 ? "ex" : "ices", command.indices.size()),
               "a block sets the elements of an array one by one");
    }

    void add_choice(const LsysCommand& command) {
        std::vector<std::uint32_t> ends;
        for (const LsysCommandArm& arm : command.arms) {
            std::uint32_t test = 0;
            if (arm.condition) {
                test = here();
                append(Step::go_unless, command);
                formula(*arm.condition, program_.instructions[test].value);
            }
            add(arm.commands);
            if (&arm != &command.arms.back()) {
                ends.push_back(here());
                append(Step::go, command);
            }
            if (arm.condition) program_.instructions[test].to = here();
        }
        for (const std::uint32_t end : ends)
            program_.instructions[end].to = here();
    }

    void add_loop(const LsysCommand& command) {
        ++loops_;
        const std::uint32_t test = here();
        append(Step::go_unless, command);
        formula(*command.arms[0].condition, program_.instructions[test].value);
        add(command.arms[0].commands);
        append(Step::go, command).to = test;
        program_.instructions[test].to = here();
        --loops_;
    }

    void add_loop_after(const LsysCommand& command) {
        ++loops_;
        const std::uint32_t begin = here();
        add(command.arms[0].commands);
        const std::uint32_t test = here();
        append(Step::go_if, command).to = begin;
        formula(*command.arms[0].condition, program_.instructions[test].value);
        --loops_;
    }

    const LsysProgramNames& names_;
    Diagnostics& diagnostics_;
    LsysProgram program_;
    unsigned loops_ = 0; ///< around what is added
};

template<typename Ask> bool any_code(const LsysProgram& program, const Ask& ask) {
    return std::ranges::any_of(program.instructions, [&](const LsysInstruction& instruction) {
        return (instruction.value && ask(instruction.value->code)) ||
               std::ranges::any_of(instruction.indices, [&](const LsysFormula& f) { return ask(f.code); });
    });
}

} // namespace

bool LsysProgram::reads(std::size_t slot) const {
    return any_code(*this, [&](const ExpressionCode& code) { return code.reads(slot); });
}

bool LsysProgram::reads_changing_cells() const {
    return any_code(*this, [](const ExpressionCode& code) { return code.reads_changing_cells(); });
}

LsysProgram compile_program(const LsysCommands& commands, const LsysProgramNames& names,
                            Diagnostics& diagnostics) {
    return ProgramCompiler(names, diagnostics).run(commands);
}

std::optional<LsysFormula> compile_formula(const Expression& expression, const LsysProgramNames& names,
                                           Diagnostics& diagnostics) {
    const std::uint32_t before = names.draws ? *names.draws : 0;
    auto code =
        ExpressionCode::compile(expression, names.lets, names.slots, diagnostics, names.draws, &names.cells);
    if (!code) return std::nullopt;
    const std::uint32_t after = names.draws ? *names.draws : 0;
    return LsysFormula{std::move(*code), static_cast<std::uint32_t>(names.slots.size()) + before,
                       after - before};
}

bool LsysMachine::count(const LsysInstruction& instruction) {
    if (meter_) meter_->add(1, StagePrice::module);
    if (done_++ < most_) return true;
    diagnostics_
        .error(instruction.source->span, fmt::format("the blocks carry out more than {} statements", most_))
        .with_hint("does a loop end?");
    return false;
}

std::optional<double> LsysMachine::value(const LsysFormula& formula, const State& state) {
    if (formula.draws > 0 && state.chance) formula.refill(state.slots, *state.chance);
    const std::optional<double> result = formula.code.value(state.slots, state.cells);
    if (!result) formula.code.report(state.slots, lets_, state.names, diagnostics_, state.cells);
    return result;
}

std::optional<std::uint32_t> LsysMachine::element(const LsysInstruction& instruction, const State& state) {
    std::uint32_t at = 0;
    for (std::uint32_t i = 0; i < instruction.indices.size(); ++i) {
        const std::optional<double> number = value(instruction.indices[i], state);
        if (!number) return std::nullopt;
        const std::uint32_t size = instruction.array.sizes[i];
        const std::optional<std::uint32_t> index = cell_index(*number, size);
        if (!index) {
            diagnostics_.error(instruction.source->indices[i].span,
                               fmt::format("this index of '{}' must lie between 0 and {}, but is {}",
                                           instruction.source->target, size - 1, shortest(*number)));
            return std::nullopt;
        }
        at = at * size + *index;
    }
    return instruction.to + at;
}

bool LsysMachine::run(const LsysProgram& program, const State& state) {
    const std::vector<LsysInstruction>& steps = program.instructions;
    for (std::size_t at = 0; at < steps.size();) {
        const LsysInstruction& step = steps[at++];
        if (!count(step)) return false;
        std::uint32_t to = step.to;
        if (step.kind == Step::set_element) {
            const std::optional<std::uint32_t> place = element(step, state);
            if (!place) return false;
            to = *place;
        }
        std::optional<double> number = 0.0;
        if (step.value) number = value(*step.value, state);
        if (!number) return false;
        switch (step.kind) {
        case Step::set_slot:
            state.slots[to] = *number;
            break;
        case Step::set_cell:
        case Step::set_element:
            state.written_cells[to] = *number;
            break;
        case Step::go_unless:
            if (*number == 0) at = to;
            break;
        case Step::go_if:
            if (*number != 0) at = to;
            break;
        case Step::go:
            at = to;
            break;
        }
    }
    return true;
}

} // namespace graftal
