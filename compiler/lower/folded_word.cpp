#include "compiler/lower/folded_word.h"

#include <algorithm>

#include "compiler/lower/lsys_rewriter.h"

namespace graftal {

namespace {

/// Longer strings are cut into runs.
constexpr std::size_t longest_string = 256;
constexpr std::size_t shortest_run = 8;
constexpr std::size_t longest_run = 32;

} // namespace

FoldedWord::FoldedWord(const LsysGrammar& grammar, const ModuleTable& modules, std::span<const ModuleId> word)
    : grammar_(grammar), modules_(modules),
      has_polygons_(std::ranges::find(grammar.commands, TurtleCommand::open_polygon) != grammar.commands.end()) {
    static_assert(max_distinct_modules < run_mark);
    std::vector<std::size_t> open; // where the branches begin
    for (const ModuleId module : word) {
        const TurtleCommand command = command_of(module);
        if (command == TurtleCommand::open_branch) {
            open.push_back(trunk_.size());
        } else if (command == TurtleCommand::close_branch) {
            cut_into_runs(open.back());
            const ModuleId branch = number_of(std::span(trunk_).subspan(open.back()), branch_mark);
            trunk_.resize(open.back());
            trunk_.push_back(branch);
            open.pop_back();
        } else {
            trunk_.push_back(module);
        }
    }
    cut_into_runs(0);
}

/// What follows from `first` on.
void FoldedWord::cut_into_runs(std::size_t first) {
    while (trunk_.size() - first > longest_string) {
        std::size_t count = first;
        for (std::size_t from = first; from < trunk_.size();) {
            const std::size_t to = end_of_run(from);
            trunk_[count++] = number_of(std::span(trunk_).subspan(from, to - from), run_mark);
            from = to;
        }
        trunk_.resize(count);
    }
}

/// Of the places in reach, the one where the modules around it have the least hash: whatever came before, soon
/// the same places are chosen in equal strings. Not inside of a polygon.
std::size_t FoldedWord::end_of_run(std::size_t first) const {
    const std::size_t size = trunk_.size();
    if (size - first <= longest_run) return size;
    std::size_t end = size;
    std::uint64_t least = UINT64_MAX;
    std::size_t open = 0; // polygons
    for (std::size_t at = first; at < size && (at - first < longest_run || end == size); ++at) {
        const ModuleId module = trunk_[at];
        if (open == 0 && at - first >= shortest_run) {
            const std::uint64_t hash = mixed(mixed(mixed(trunk_[at - 2], trunk_[at - 1]), module), 0);
            if (hash < least) least = hash, end = at;
        }
        if (!has_polygons_ || is_piece(module)) continue;
        if (command_of(module) == TurtleCommand::open_polygon) ++open;
        if (command_of(module) == TurtleCommand::close_polygon && open > 0) --open;
    }
    return end;
}

ModuleId FoldedWord::number_of(std::span<const ModuleId> piece, ModuleId mark) {
    std::uint64_t hash = mark;
    for (const ModuleId module : piece)
        hash = mixed(hash, module);
    const auto next = static_cast<std::uint32_t>(ranges_.size());
    const std::uint32_t id = ids_.find_or_add(hash, next, [&](std::uint32_t other) {
        const Range& known = ranges_[other];
        return known.mark == mark && std::ranges::equal(this->piece(other), piece);
    });
    if (id == next) {
        ranges_.push_back({store_.size(), piece.size(), mark});
        store_.insert(store_.end(), piece.begin(), piece.end());
    }
    return id | mark;
}

} // namespace graftal
