#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lsys/parse/ast.h"
#include "compiler/support/control.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/diagnostics.h"
#include "compiler/syntax/expression_code.h"

// Blocks that assign values, between their tree and being carried out.

namespace graftal {

/// Random numbers one after the other, for what is carried out in order.
class LsysChance {
  public:
    explicit LsysChance(CounterRandom random) : random_(random) {}

    /// Uniform over all 64 bits.
    std::uint64_t draw() { return random_(count_++); }
    /// Uniform over [0, 1).
    double unit() { return CounterRandom::unit(draw()); }

  private:
    CounterRandom random_;
    std::uint64_t count_ = 0;
};

/// An expression with the slots of its random numbers.
struct LsysFormula {
    ExpressionCode code;
    std::uint32_t first_draw = 0; ///< slot
    std::uint32_t draws = 0;

    /// Draws them anew.
    void refill(std::span<double> slots, LsysChance& chance) const {
        for (std::uint32_t i = 0; i < draws; ++i)
            slots[first_draw + i] = chance.unit();
    }
};

/// One step of a program.
struct LsysInstruction {
    enum class Kind : std::uint8_t { set_slot, set_cell, set_element, go_unless, go_if, go };

    Kind kind = Kind::go;
    std::uint32_t to = 0; ///< slot, cell or instruction
    CellPlace array;      ///< of `set_element`
    std::vector<LsysFormula> indices;
    std::optional<LsysFormula> value; ///< or condition
    const LsysCommand* source = nullptr;
};

/// A block of commands. Constant once compiled.
struct LsysProgram {
    std::vector<LsysInstruction> instructions;
    bool sets_cells = false;
    bool draws_anew = false; ///< calls of chance whose numbers are drawn whenever they are reached

    bool empty() const { return instructions.empty(); }
    bool reads(std::size_t slot) const;
    bool reads_changing_cells() const;
};

/// The meanings of names in a program.
struct LsysProgramNames {
    const Environment& lets;
    const CellPlaces& cells;
    /// The names of the slots; empty for slots without. An assignment to one of these sets it.
    std::span<const std::string_view> slots;
    /// Counts calls of chance, each with a slot of its own behind those with names; null: they are errors.
    std::uint32_t* draws = nullptr;
    /// Whether numbers of chance are drawn whenever a call is reached; else only those in loops are, and the
    /// others are in their slots before.
    bool draws_anew = true;
};

/// Reports names that are unknown, and assignments to what does not change.
LsysProgram compile_program(const LsysCommands& commands, const LsysProgramNames& names,
                            Diagnostics& diagnostics);

/// Compiles an expression whose chance may be drawn anew.
std::optional<LsysFormula> compile_formula(const Expression& expression, const LsysProgramNames& names,
                                           Diagnostics& diagnostics);

/// Most instructions that all programs of a derivation may carry out.
inline constexpr std::uint64_t max_instructions = 100'000'000;

/// Carries programs out, within one budget.
class LsysMachine {
  public:
    /// Both must outlive this; the meter may be null.
    LsysMachine(const Environment& lets, Diagnostics& diagnostics, WorkMeter* meter,
                std::uint64_t most = max_instructions)
        : lets_(lets), diagnostics_(diagnostics), meter_(meter), most_(most) {}

    /// The values that a program works on.
    struct State {
        std::span<double> slots;                 ///< with those of chance
        std::span<const std::string_view> names; ///< of the slots
        std::span<const double> cells;           ///< cells to read
        std::span<double> written_cells;         ///< cells to set; empty where no program sets any
        LsysChance* chance = nullptr;            ///< where numbers are drawn anew
    };
    /// False after an error.
    bool run(const LsysProgram& program, const State& state);

    /// The value of a formula, with its chance drawn anew; nothing after an error, which is reported.
    std::optional<double> value(const LsysFormula& formula, const State& state);

  private:
    std::optional<std::uint32_t> element(const LsysInstruction& instruction, const State& state);
    bool count(const LsysInstruction& instruction);

    const Environment& lets_;
    Diagnostics& diagnostics_;
    WorkMeter* meter_;
    std::uint64_t most_;
    std::uint64_t done_ = 0;
};

} // namespace graftal
