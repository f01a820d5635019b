#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/support/control.h"

namespace graftal {

/// The numbers of letters in the rules of a system that is looked for. They decide how many segments it
/// draws after each step (Vitanyi 1980, growth functions of D0L systems).
struct Growth {
    static constexpr std::size_t most_letters = 4;
    using Counts = std::array<std::uint8_t, most_letters>;

    std::size_t letters = 1;
    std::size_t drawn = 1;     ///< the first so many draw a segment; others draw nothing
    std::uint8_t straight = 0; ///< the first letter becomes so many of itself in a row; 0: as its rule says
    /// Whether each letter has its numbers. Else rules have as many letters that draw, and as many that do
    /// not, in all; they stand in the columns of letters 0 and `drawn`.
    bool by_letter = true;
    std::array<Counts, most_letters> rules{};
    std::size_t axiom_letter = 0;
    std::uint8_t axiom = 1; ///< letters of the axiom
    unsigned steps = 2;

    std::size_t drawn_in(std::size_t rule) const;
    std::size_t hidden_in(std::size_t rule) const;
    /// Letters of the axiom and of all rules.
    std::size_t size() const;
};

/// Numbers of letters, within bounds, that draw so many segments after two or more steps; smaller ones come
/// first, then those of more steps. `rich`: of three letters with rules of their own; else of one or two, or
/// of several whose rules have one length. `sized`: segments of each step have a length of their own.
std::vector<Growth> growths(std::uint64_t segments, bool rich, bool sized, WorkMeter& meter);

} // namespace graftal
