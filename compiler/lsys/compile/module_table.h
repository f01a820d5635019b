#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compiler/support/id_table.h"

namespace graftal {

using SymbolId = std::uint16_t;
/// A module with the values of its parameters; equal modules have one id.
using ModuleId = std::uint32_t;
using ModuleString = std::vector<ModuleId>;

/// The number without rounding, where that can be told: the decimal of some twelve digits within 8e-15 of
/// it, relative to itself; else the number itself. So 1 + 0.2 + 0.2 + 0.2 + 0.2 + 0.2 is 2, whatever was
/// computed before.
double unrounded(double number);

/// Numbers that differ by rounding only, made equal: the first that came, unrounded(), stands for all within
/// a relative 1e-12. So l * r1 * r2 and l * r2 * r1 are one length, wherever it came from.
class NumberTable {
  public:
    /// The number that stands for a finite one; zeros of both signs for 0.
    double representative(double number);

  private:
    std::vector<double> numbers_;
    IdTable ids_;
};

/// All modules of a derivation, each once: a string of them takes four bytes a module.
class ModuleTable {
  public:
    /// The step in which a module came into being, where nothing is said about it.
    static constexpr std::uint32_t no_birth = UINT32_MAX;

    /// Requires finite parameters. Parameters that a NumberTable takes for equal make equal modules, if they
    /// have the same birth.
    ModuleId intern(SymbolId symbol, std::span<const double> parameters, std::uint32_t birth = no_birth);

    SymbolId symbol(ModuleId id) const { return entries_[id].symbol; }
    /// Valid until the next intern().
    std::span<const double> parameters(ModuleId id) const {
        return std::span(parameters_).subspan(entries_[id].first, entries_[id].arity);
    }
    std::uint32_t birth(ModuleId id) const { return entries_[id].birth; }
    std::size_t size() const { return entries_.size(); }

  private:
    struct Entry {
        SymbolId symbol = 0;
        std::uint16_t arity = 0;
        std::uint32_t first = 0; ///< of its parameters
        std::uint32_t birth = no_birth;
    };

    std::vector<Entry> entries_;
    std::vector<double> parameters_;
    std::vector<double> wanted_;
    NumberTable numbers_;
    IdTable ids_;
};

} // namespace graftal
