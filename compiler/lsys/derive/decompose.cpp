#include "compiler/lsys/derive/decompose.h"

#include <fmt/format.h>

namespace graftal {

LsysDecomposer::LsysDecomposer(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t max_modules)
    : rewriter_(rewriter), diagnostics_(diagnostics), max_modules_(max_modules) {
    const LsysGrammar& grammar = rewriter.grammar();
    has_rules_ = grammar.has_rules(RuleKind::decompose);
    varies_ = grammar.is_random(RuleKind::decompose) || grammar.time(RuleKind::decompose) != 0;
}

Moment LsysDecomposer::moment(ModuleId module) const {
    return moment_of(step_, rewriter_.modules().birth(module));
}

bool LsysDecomposer::run(std::span<const ModuleId> word, const CounterRandom& random, ModuleString& out) {
    applied_ = 0;
    for (std::size_t i = 0; i < word.size(); ++i) {
        rewriter_.work();
        if (!rewriter_.is_rewritten(RuleKind::decompose, word[i], moment(word[i])))
            out.push_back(word[i]);
        else if (!run(word[i], random.sequence(i), out))
            return false;
    }
    return true;
}

bool LsysDecomposer::run(ModuleId module, const CounterRandom& random, ModuleString& out) {
    std::uint64_t draws = 0;
    pending_.assign(1, {module, 0});
    while (!pending_.empty()) {
        const auto [next, depth] = pending_.back();
        pending_.pop_back();
        rewriter_.work();
        const std::vector<Alternative>* alternatives =
            rewriter_.alternatives(RuleKind::decompose, next, moment(next));
        if (!alternatives) return false;
        if (alternatives->empty()) {
            out.push_back(next);
            continue;
        }
        if (depth == max_decomposition_depth || ++applied_ > max_modules_)
            return refuse(module, "does not end");
        const Winner<Alternative> chosen = choose(alternatives->data(), random(draws++));
        const ModuleString* const successor =
            rewriter_.successor(*chosen.entrant, next, moment(next), chosen.even());
        if (!successor) return false;
        if (out.size() + pending_.size() + successor->size() > max_modules_)
            return refuse(module, "is too long");
        for (auto part = successor->rbegin(); part != successor->rend(); ++part)
            pending_.push_back({*part, depth + 1});
    }
    return true;
}

bool LsysDecomposer::refuse(ModuleId module, std::string_view what) {
    const LsysGrammar& grammar = rewriter_.grammar();
    const SymbolId symbol = rewriter_.modules().symbol(module);
    return refuse_decomposition(grammar,
                                grammar.rules[grammar.candidates(RuleKind::decompose, symbol).front()], what,
                                max_modules_, diagnostics_);
}

bool refuse_decomposition(const LsysGrammar& grammar, const LsysRule& rule, std::string_view what,
                          std::uint64_t max_modules, Diagnostics& diagnostics) {
    diagnostics
        .error(rule.source->span,
               fmt::format("the decomposition of '{}' {}", grammar.symbols[rule.predecessor.symbol], what))
        .with_hint(fmt::format("graftal follows at most {} levels and {} modules; give a module that recurs "
                               "a condition that becomes false",
                               max_decomposition_depth, max_modules));
    return false;
}

} // namespace graftal
