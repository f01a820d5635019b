#include "runtime/inverse/lsystem/growth.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace graftal {

namespace {

constexpr unsigned most_steps = 14;
constexpr std::uint8_t most_axiom_letters = 6;
constexpr double seconds_of_growth = 1e-7; ///< of one table of numbers, for all steps

using Counts = LsysGrowth::Counts;

/// All rows with bounds on their numbers, and from one letter to `most` in all.
std::vector<Counts> rows(std::size_t letters, const Counts& bounds, std::size_t most) {
    std::vector<Counts> found;
    Counts row{};
    const auto fill = [&](const auto& self, std::size_t at, std::size_t left) -> void {
        if (at == letters) {
            if (left < most) found.push_back(row);
            return;
        }
        for (std::size_t n = 0; n <= std::min<std::size_t>(bounds[at], left); ++n) {
            row[at] = static_cast<std::uint8_t>(n);
            self(self, at + 1, left - n);
        }
        row[at] = 0;
    };
    fill(fill, 0, most);
    return found;
}

/// Whether the axiom's letter leads to all letters, apart from the first where it is straight.
bool reaches_all(const LsysGrowth& growth) {
    if (!growth.by_letter) return true;
    std::array<bool, LsysGrowth::most_letters> seen{};
    seen[growth.axiom_letter] = true;
    for (std::size_t round = 0; round < growth.letters; ++round)
        for (std::size_t from = 0; from < growth.letters; ++from)
            for (std::size_t to = 0; to < growth.letters; ++to)
                if (seen[from] && growth.rules[from][to] > 0) seen[to] = true;
    return std::all_of(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(growth.letters),
                       [](bool reached) { return reached; });
}

/// Whether exchanging letters that no axiom tells apart gives a table that is listed before.
bool is_repeated(const LsysGrowth& growth) {
    for (std::size_t a = 0; a < growth.letters; ++a)
        for (std::size_t b = a + 1; b < growth.letters; ++b) {
            const bool alike = (a < growth.drawn) == (b < growth.drawn) && a != growth.axiom_letter &&
                               b != growth.axiom_letter && !(growth.straight && a == 0);
            if (!alike) continue;
            std::array<Counts, LsysGrowth::most_letters> other = growth.rules;
            std::swap(other[a], other[b]);
            for (Counts& row : other)
                std::swap(row[a], row[b]);
            if (other < growth.rules) return true;
        }
    return false;
}

class GrowthTable {
  public:
    GrowthTable(std::uint64_t segments, WorkMeter& meter) : segments_(segments), meter_(meter) {}

    /// Adds the growth with each number of steps, and of letters of the axiom, that suits.
    void try_steps(LsysGrowth growth) {
        meter_.add(1, seconds_of_growth);
        std::array<std::uint64_t, LsysGrowth::most_letters> drawn{};
        std::fill_n(drawn.begin(), growth.drawn, 1);
        bool checked = false;
        for (unsigned step = 1; step <= most_steps; ++step) {
            std::array<std::uint64_t, LsysGrowth::most_letters> next{};
            for (std::size_t rule = 0; rule < growth.letters; ++rule)
                for (std::size_t letter = 0; letter < growth.letters; ++letter)
                    next[rule] += growth.rules[rule][letter] * drawn[letter];
            const bool grows = next != drawn;
            drawn = next;
            const std::uint64_t count = drawn[growth.axiom_letter];
            if (count > segments_ || !grows) return;
            if (step < 2 || count == 0 || segments_ % count != 0 || segments_ / count > most_axiom_letters)
                continue;
            if (!checked && (!reaches_all(growth) || (growth.drawn == 1 && is_repeated(growth)))) return;
            checked = true;
            growth.steps = step;
            growth.axiom = static_cast<std::uint8_t>(segments_ / count);
            found_.push_back(growth);
        }
    }

    /// Tries all tables whose rules are rows of these lists, by letter.
    void try_rows(LsysGrowth growth, const std::vector<std::vector<Counts>>& lists, std::size_t most_size,
                  std::size_t at = 0) {
        if (at == growth.letters) {
            if (growth.size() <= most_size) try_steps(growth);
            return;
        }
        for (const Counts& row : lists[at]) {
            growth.rules[at] = row;
            try_rows(growth, lists, most_size, at + 1);
        }
    }

    /// Keeps of each growth only how many letters its rules have, once each.
    void forget_letters() {
        for (LsysGrowth& growth : found_) {
            growth.by_letter = false;
            for (std::size_t rule = growth.straight ? 1 : 0; rule < growth.letters; ++rule) {
                const std::size_t drawn = growth.drawn_in(rule), hidden = growth.hidden_in(rule);
                growth.rules[rule] = {};
                growth.rules[rule][0] = static_cast<std::uint8_t>(drawn);
                if (growth.drawn < growth.letters)
                    growth.rules[rule][growth.drawn] = static_cast<std::uint8_t>(hidden);
            }
        }
        const auto key = [](const LsysGrowth& g) {
            return std::tuple(g.letters, g.drawn, g.straight, g.steps, g.axiom, g.rules);
        };
        std::ranges::sort(found_, {}, key);
        const auto same = [&](const LsysGrowth& a, const LsysGrowth& b) { return key(a) == key(b); };
        found_.erase(std::unique(found_.begin(), found_.end(), same), found_.end());
    }

    std::vector<LsysGrowth> sorted() {
        std::ranges::stable_sort(found_, [](const LsysGrowth& a, const LsysGrowth& b) {
            return a.size() != b.size() ? a.size() < b.size() : a.steps > b.steps;
        });
        return std::move(found_);
    }

  private:
    std::uint64_t segments_;
    WorkMeter& meter_;
    std::vector<LsysGrowth> found_;
};

/// Letters that all draw, of which only the lengths of their rules are known: all lengths within a bound, or
/// one for all.
void add_edge_systems(GrowthTable& table, std::uint8_t letters, std::uint8_t longest, bool for_tree) {
    LsysGrowth growth{.letters = letters, .drawn = letters};
    std::vector<Counts> list = rows(letters, {longest, longest, longest}, longest);
    std::erase(list, Counts{});
    if (letters > 1) table.try_rows(growth, std::vector(letters, list), SIZE_MAX);
    if (for_tree) return;
    table.forget_letters();
    growth.by_letter = letters == 1;
    for (std::uint8_t length = letters == 1 ? 2 : longest + 1; length <= 40; ++length) {
        for (std::size_t rule = 0; rule < letters; ++rule)
            growth.rules[rule] = {length};
        table.try_steps(growth);
    }
}

void add_three_nodes(GrowthTable& table, std::uint8_t straight, bool for_tree) {
    LsysGrowth growth{.letters = 4, .drawn = 1, .straight = straight, .axiom_letter = 1};
    growth.rules[0][0] = straight;
    const std::vector<Counts> three = for_tree ? rows(4, {5, 2, 2, 2}, 8) : rows(4, {3, 3, 3, 3}, 6);
    table.try_rows(growth, {{growth.rules[0]}, three, three, three}, for_tree ? 22 : 19);
}

/// A letter that draws, and grows straight; others mark where rules go on.
void add_node_systems(GrowthTable& table, std::uint8_t hidden, std::uint8_t straight, bool for_tree) {
    LsysGrowth growth{.letters = std::size_t{1} + hidden,
                      .drawn = 1,
                      .straight = straight,
                      .by_letter = hidden == 1,
                      .axiom_letter = 1};
    growth.rules[0][0] = straight;
    for (std::uint8_t segments = 1; segments <= 40; ++segments)
        for (std::uint8_t nodes = 1; nodes <= 30; ++nodes) {
            for (std::size_t rule = 1; rule <= hidden; ++rule)
                growth.rules[rule] = {segments, nodes};
            table.try_steps(growth);
        }
    growth.by_letter = true;
    const std::vector<Counts> two = rows(3, {7, 5, 5}, 10);
    if (hidden == 2) table.try_rows(growth, {{growth.rules[0]}, two, two}, 20);
    if (hidden == 3) add_three_nodes(table, straight, for_tree);
}

/// A letter that draws and has a rule of its own, beside one that does not.
void add_mixed_systems(GrowthTable& table) {
    const std::vector<Counts> drawn = rows(2, {8, 2}, 9), hidden = rows(2, {6, 5}, 9);
    table.try_rows({.letters = 2, .drawn = 1, .axiom_letter = 1}, {drawn, hidden}, 17);
}

} // namespace

std::size_t LsysGrowth::drawn_in(std::size_t rule) const {
    if (rule == letters) return axiom_letter < drawn ? axiom : 0;
    return std::accumulate(rules[rule].begin(), rules[rule].begin() + static_cast<std::ptrdiff_t>(drawn),
                           std::size_t{0});
}

std::size_t LsysGrowth::hidden_in(std::size_t rule) const {
    if (rule == letters) return axiom_letter < drawn ? 0 : axiom;
    return std::accumulate(rules[rule].begin() + static_cast<std::ptrdiff_t>(drawn), rules[rule].end(),
                           std::size_t{0});
}

std::size_t LsysGrowth::size() const {
    std::size_t sum = axiom;
    for (std::size_t rule = 0; rule < letters; ++rule)
        sum += drawn_in(rule) + hidden_in(rule);
    return sum;
}

SegmentRange segment_range(const LsysGrowth& growth, const PartialRules& rules, std::uint64_t limit) {
    std::array<SegmentRange, LsysGrowth::most_letters> range{};
    std::fill_n(range.begin(), growth.drawn, SegmentRange{1, 1});
    for (unsigned step = 0; step < growth.steps; ++step) {
        const std::array<SegmentRange, LsysGrowth::most_letters> before = range;
        SegmentRange drawn{limit, 0}, hidden{limit, 0};
        for (std::size_t letter = 0; letter < growth.letters; ++letter) {
            SegmentRange& group = letter < growth.drawn ? drawn : hidden;
            group = {std::min(group.least, before[letter].least), std::max(group.most, before[letter].most)};
        }
        for (std::size_t rule = 0; rule < growth.letters; ++rule) {
            const PartialRule& known = rules[rule];
            std::uint64_t least = known.drawn * drawn.least + known.hidden * hidden.least,
                          most = known.drawn * drawn.most + known.hidden * hidden.most;
            for (std::size_t letter = 0; letter < growth.letters; ++letter) {
                least += known.counts[letter] * before[letter].least;
                most += known.counts[letter] * before[letter].most;
            }
            range[rule] = {std::min(least, limit), std::min(most, limit)};
        }
    }
    return range[growth.axiom_letter];
}

std::vector<LsysGrowth> growths(std::uint64_t segments, GrowthKind kind, bool sized, WorkMeter& meter,
                                bool for_tree) {
    GrowthTable table(segments, meter);
    if (kind <= GrowthKind::three_edges) {
        constexpr std::uint8_t longest[] = {1, 10, 7};
        const auto number = static_cast<std::uint8_t>(kind);
        if (!sized) add_edge_systems(table, number + 1, longest[number], for_tree);
        return table.sorted();
    }
    if (kind == GrowthKind::one_node && !sized) add_mixed_systems(table);
    for (int straight = 1; straight <= (sized ? 1 : 3); ++straight)
        add_node_systems(table, static_cast<std::uint8_t>(kind) - 2, static_cast<std::uint8_t>(straight),
                         for_tree);
    return table.sorted();
}

} // namespace graftal
