#include "compiler/lsys/derive/word.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace graftal {

namespace {

bool cuts(const LsysGrammar& grammar, const std::vector<LsysTemplate>& string) {
    return std::ranges::any_of(string, [&](const LsysTemplate& module) {
        return grammar.commands[module.symbol] == TurtleCommand::cut;
    });
}

} // namespace

bool has_cuts(const LsysGrammar& grammar) {
    return cuts(grammar, grammar.axiom) || std::ranges::any_of(grammar.rules, [&](const LsysRule& rule) {
               return cuts(grammar, rule.successor);
           });
}

void cut_branches(const LsysGrammar& grammar, const ModuleTable& modules, ModuleString& word) {
    const auto command = [&](ModuleId module) { return grammar.commands[modules.symbol(module)]; };
    auto kept = word.begin();
    for (auto at = word.begin(); at != word.end(); ++at) {
        *kept++ = *at;
        if (command(*at) != TurtleCommand::cut) continue;
        for (std::size_t open = 0; at + 1 != word.end(); ++at) {
            const TurtleCommand next = command(at[1]);
            if (next == TurtleCommand::open_branch) ++open;
            if (next == TurtleCommand::close_branch && open-- == 0) break;
        }
    }
    word.erase(kept, word.end());
}

bool refuse_length(const LsysGrammar& grammar, std::uint64_t max_modules, std::uint32_t step,
                   Diagnostics& diagnostics) {
    const LsysBlock& block = *grammar.source;
    diagnostics
        .error(block.steps ? block.steps->span : block.name.span,
               fmt::format("the derivation has more than {} modules after step {}", max_modules, step))
        .with_hint("use fewer steps for a shorter one");
    return false;
}

bool refuse_endless(const LsysGrammar& grammar, RuleKind kind, SymbolId symbol, Span production,
                    Diagnostics& diagnostics) {
    diagnostics
        .error(production, fmt::format("the {} of '{}' does not end",
                                       kind == RuleKind::interpret ? "interpretation" : "decomposition",
                                       grammar.symbols[symbol]))
        .with_hint("graftal applies these productions again and again until none fits: add a condition "
                   "that ends this");
    return false;
}

} // namespace graftal
