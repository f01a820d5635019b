#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/compile/program.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// Most values that the variables of a derivation may have in all its steps.
inline constexpr std::uint64_t max_recorded_cells = 16'000'000;

/// The values of a block's variables in the course of a derivation. Where only the blocks of steps change
/// them, they are recorded once: what is composed asks for steps in any order. Else they are as they are now.
class LsysVariables {
  public:
    /// All must outlive this.
    LsysVariables(const LsysGrammar& grammar, LsysMachine& machine, Diagnostics& diagnostics,
                  std::uint64_t seed);

    /// Records all steps of a derivation; false after an error. Requires a grammar without order.
    bool record(unsigned steps);
    /// The steps that are recorded.
    std::optional<unsigned> recorded() const { return recorded_; }
    /// While a step is carried out; 0: for the axiom, and its decomposition.
    std::span<const double> during(unsigned step) const { return row(during_, step); }
    /// When the word after a step is drawn.
    std::span<const double> after(unsigned step) const { return row(after_, step); }

    /// Each carries out a block of the derivation, where there is one; false after an error.
    bool start();
    bool start_each(unsigned step);
    bool end_each(unsigned step);
    bool end(unsigned steps);
    /// The values as they are now.
    std::span<double> now() { return now_; }
    std::span<const double> now() const { return now_; }

  private:
    bool run(const LsysProgram& program, unsigned step, std::uint64_t part);
    bool keep(std::vector<std::uint32_t>& rows);
    std::span<const double> row(const std::vector<std::uint32_t>& rows, unsigned step) const;

    const LsysGrammar& grammar_;
    LsysMachine& machine_;
    Diagnostics& diagnostics_;
    CounterRandom random_;
    std::vector<double> now_;
    std::vector<double> slots_;
    std::optional<unsigned> recorded_;
    std::vector<std::vector<double>> rows_;     ///< different rows
    std::vector<std::uint32_t> during_, after_; ///< by step, in rows_
};

} // namespace graftal
