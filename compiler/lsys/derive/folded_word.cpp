#include "compiler/lsys/derive/folded_word.h"

#include <algorithm>
#include <utility>

#include "compiler/lsys/derive/rewriter.h"

namespace graftal {

namespace {

/// Longer strings are cut into runs.
constexpr std::size_t longest_string = 256;
constexpr std::size_t shortest_run = 8;
constexpr std::size_t longest_run = 32;

/// One multiplication after another would take most of the time.
std::uint64_t hash_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    return mixed(0, a * 0xBF58476D1CE4E5B9ull + b * 0x94D049BB133111EBull + c);
}

} // namespace

FoldedWord::FoldedWord(const LsysGrammar& grammar, const ModuleTable& modules, ModuleString word)
    : trunk_(std::move(word)) {
    static_assert(max_distinct_modules < run_mark);
    if (grammar.polygons_cross_branches) return;
    if (std::ranges::find(grammar.commands, TurtleCommand::open_polygon) != grammar.commands.end())
        for (ModuleId module = 0; module < modules.size(); ++module) {
            const TurtleCommand command = grammar.commands[modules.symbol(module)];
            opens_polygon_.push_back(command == TurtleCommand::open_polygon);
            closes_polygon_.push_back(command == TurtleCommand::close_polygon);
        }
    fold(grammar.commands, modules);
    trunk_.shrink_to_fit();
}

void FoldedWord::fold(const std::vector<TurtleCommand>& commands, const ModuleTable& modules) {
    std::vector<std::size_t> open; // where the branches begin
    std::size_t last = 0;
    for (const ModuleId module : trunk_) {
        const TurtleCommand command = commands[modules.symbol(module)];
        if (command == TurtleCommand::open_branch) {
            open.push_back(last);
        } else if (command == TurtleCommand::close_branch) {
            const std::size_t first = open.back();
            open.pop_back();
            trunk_[first] = number_of(first, cut_into_runs(first, last), branch_mark);
            last = first + 1;
        } else {
            trunk_[last++] = module;
        }
    }
    trunk_.resize(cut_into_runs(0, last));
}

/// The new end of what stands from `first` to `last`.
std::size_t FoldedWord::cut_into_runs(std::size_t first, std::size_t last) {
    while (last - first > longest_string) {
        std::size_t count = first;
        for (std::size_t from = first; from < last;) {
            const std::size_t to = end_of_run(from, last);
            trunk_[count++] = number_of(from, to, run_mark);
            from = to;
        }
        last = count;
    }
    return last;
}

/// The place in reach where the modules around it have the least hash, outside of polygons. Equal strings
/// soon choose the same places, whatever came before them.
std::size_t FoldedWord::end_of_run(std::size_t first, std::size_t last) const {
    if (last - first <= longest_run) return last;
    std::size_t end = last;
    std::uint64_t least = UINT64_MAX;
    std::size_t open = 0; // polygons
    for (std::size_t at = first; at < last && (at - first < longest_run || end == last); ++at) {
        const ModuleId module = trunk_[at];
        if (open == 0 && at - first >= shortest_run) {
            const std::uint64_t hash = hash_of(trunk_[at - 2], trunk_[at - 1], module);
            if (hash < least) least = hash, end = at;
        }
        if (module >= opens_polygon_.size()) continue;
        if (opens_polygon_[module]) ++open;
        if (closes_polygon_[module] && open > 0) --open;
    }
    return end;
}

ModuleId FoldedWord::number_of(std::size_t first, std::size_t last, ModuleId mark) {
    const std::span<const ModuleId> piece = std::span(trunk_).subspan(first, last - first);
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
