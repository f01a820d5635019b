#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/support/control.h"

namespace graftal {

/// The numbers of letters in the rules of a system that is looked for. They decide how many segments it
/// draws after each step (Vitanyi 1980, growth functions of D0L systems).
struct LsysGrowth {
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

/// The letters of a rule as far as they are known.
struct PartialRule {
    LsysGrowth::Counts counts{};
    std::uint8_t drawn = 0, hidden = 0; ///< others that draw, and that do not, in some of the letters
};

using PartialRules = std::array<PartialRule, LsysGrowth::most_letters>;

/// The least and the most segments that a letter of the axiom draws. Counts end at `limit`.
struct SegmentRange {
    std::uint64_t least = 0, most = 0;
};
SegmentRange segment_range(const LsysGrowth& growth, const PartialRules& rules, std::uint64_t limit);

/// Kinds of systems: letters that all draw, with one to three rules; or a letter that draws and grows
/// straight, with one to three others that do not. Those with one include letters that draw and have a rule
/// of their own.
enum class GrowthKind : std::uint8_t { one_edge, two_edges, three_edges, one_node, two_nodes, three_nodes };
inline constexpr std::size_t growth_kinds = 6;

/// A rule without its turns: letters by number, and brackets.
using BareWord = std::vector<std::int8_t>;
inline constexpr std::int8_t bare_open = -1, bare_close = -2;
using BareRules = std::array<BareWord, LsysGrowth::most_letters>;

/// Numbers of letters, within bounds, that draw so many segments after two or more steps; smaller ones come
/// first, then those of more steps. `sized`: segments of each step have a length of their own. `for_tree`: of
/// letters that all draw, the numbers of each; and of three that do not, longer rules of more segments.
std::vector<LsysGrowth> growths(std::uint64_t segments, GrowthKind kind, bool sized, WorkMeter& meter,
                                bool for_tree = false);

} // namespace graftal
