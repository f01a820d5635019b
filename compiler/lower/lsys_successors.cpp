#include "compiler/lower/lsys_successors.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace graftal {

namespace {

constexpr std::size_t most_known_outcomes = 1u << 22;
constexpr std::size_t most_kept_modules = 1u << 28; ///< of runs, from one step to the next

} // namespace

LsysSuccessors::LsysSuccessors(LsysRewriter& rewriter, LsysDecomposer& decomposer, Diagnostics& diagnostics)
    : rewriter_(rewriter), decomposer_(decomposer), diagnostics_(diagnostics),
      contextual_(rewriter.grammar().symbols.size()) {
    const LsysGrammar& grammar = rewriter.grammar();
    for (const auto& rules : grammar.rules_of[static_cast<std::size_t>(RuleKind::produce)])
        for (const std::uint32_t id : rules) {
            const LsysRule& rule = grammar.rules[id];
            has_context_ |= rule.has_context();
            is_stochastic_ |= rule.probability.has_value();
            if (rule.has_context()) contextual_[rule.predecessor.symbol] = true;
        }
}

void LsysSuccessors::trim() {
    if (runs_.size() <= most_kept_modules) return;
    runs_.clear();
    entries_.clear();
    choices_.clear();
    forget_outcomes();
}

void LsysSuccessors::forget_outcomes() {
    known_.clear();
    bound_modules_.clear();
    known_ids_.clear();
}

LsysSuccessors::Entry LsysSuccessors::compute(ModuleId module) {
    const Entry entry = compute_entry(module);
    if (entries_.size() <= module) entries_.resize(rewriter_.modules().size(), unknown);
    return entries_[module] = entry;
}

/// Of a module that contexts decide about: the run that leaves it as it is, with the mark.
LsysSuccessors::Entry LsysSuccessors::compute_entry(ModuleId module) {
    const LsysRule* first = nullptr;
    if (!is_contextual(module)) {
        const auto found =
            compete(module, [&](const LsysRule& rule) { return outcome(rule, std::span(&module, 1)); });
        if (!found) return unknown;
        first = *found;
    }
    if (!first) {
        const auto run = add_run(std::span(&module, 1), rewriter_.grammar().source->name.span);
        if (!run) return unknown;
        return is_contextual(module) ? *run | mark : *run;
    }
    if (!first->probability) return competing_.front().run;
    const auto entry = static_cast<Entry>(choices_.size() | mark);
    return add_choices(*first, choices_) ? entry : unknown;
}

std::optional<RunId> LsysSuccessors::choose_in_context(ModuleId module, Entry entry, std::uint64_t draw,
                                                       ContextMatcher& matcher, std::uint32_t position) {
    const auto first = compete(module, [&](const LsysRule& rule) {
        bound_.assign(1, module);
        if (rule.has_context() && !matcher.matches(rule, position, bound_)) return Outcome{};
        return known_outcome(rule, bound_);
    });
    if (!first) return std::nullopt;
    if (!*first) return entry & ~mark;
    if (!(*first)->probability) return competing_.front().run;
    chances_.clear();
    if (!add_choices(**first, chances_)) return std::nullopt;
    return choose(chances_.data(), draw);
}

/// Leaves what the rules that fit give in competing_.
template<typename OutcomeOf>
std::optional<const LsysRule*> LsysSuccessors::compete(ModuleId module, const OutcomeOf& outcome_of) {
    const ModuleTable& modules = rewriter_.modules();
    competing_.clear();
    return rewriter_.try_rules(rewriter_.grammar().candidates(RuleKind::produce, modules.symbol(module)),
                               modules.parameters(module).size(), [&](const LsysRule& rule) {
                                   const Outcome outcome = outcome_of(rule);
                                   if (outcome.fit == Fit::yes) competing_.push_back(outcome);
                                   return outcome.fit;
                               });
}

bool LsysSuccessors::add_choices(const LsysRule& first, std::vector<Choice>& choices) {
    double sum = 0;
    for (const Outcome& outcome : competing_)
        sum += outcome.probability;
    if (!rewriter_.sums_to_one(sum, first)) return false;
    double below = 0;
    for (const Outcome& outcome : competing_) {
        if (outcome.probability == 0) continue;
        below += outcome.probability / sum;
        const double upto = std::ldexp(below, 64);
        choices.push_back({upto < 0x1p64 ? static_cast<std::uint64_t>(upto) : UINT64_MAX, outcome.run});
    }
    choices.back().upto = UINT64_MAX;
    return true;
}

LsysSuccessors::Outcome LsysSuccessors::known_outcome(const LsysRule& rule, std::span<const ModuleId> bound) {
    if (known_.size() + bound_modules_.size() / 8 >= most_known_outcomes) forget_outcomes();
    std::uint64_t hash = mixed(0, static_cast<std::uint64_t>(&rule - rewriter_.grammar().rules.data()));
    for (const ModuleId module : bound)
        hash = mixed(hash, module);
    const auto next = static_cast<std::uint32_t>(known_.size());
    const std::uint32_t id = known_ids_.find_or_add(hash, next, [&](std::uint32_t other) {
        return known_[other].rule == &rule &&
               std::ranges::equal(std::span(bound_modules_).subspan(known_[other].first, known_[other].count), bound);
    });
    if (id != next) return known_[id].outcome;
    known_.push_back({&rule, static_cast<std::uint32_t>(bound_modules_.size()),
                      static_cast<std::uint32_t>(bound.size()), outcome(rule, bound)});
    bound_modules_.insert(bound_modules_.end(), bound.begin(), bound.end());
    return known_.back().outcome;
}

LsysSuccessors::Outcome LsysSuccessors::outcome(const LsysRule& rule, std::span<const ModuleId> bound) {
    values_.clear();
    for (const ModuleId module : bound) {
        const auto parameters = rewriter_.modules().parameters(module);
        values_.insert(values_.end(), parameters.begin(), parameters.end());
    }
    const Fit fit = rewriter_.apply(rule, values_, alternative_);
    if (fit != Fit::yes) return {fit};
    const std::optional<RunId> run = add_successor(alternative_.successor, rule);
    return run ? Outcome{Fit::yes, alternative_.probability, *run} : Outcome{Fit::error};
}

/// Decomposes the run for good where it can be decomposed in one way only.
std::optional<RunId> LsysSuccessors::add_successor(const ModuleString& successor, const LsysRule& rule) {
    if (!decomposer_.has_rules() || decomposer_.is_stochastic()) return add_run(successor, rule.source->span);
    decomposed_.clear();
    if (!decomposer_.run(successor, CounterRandom(0), decomposed_)) return std::nullopt;
    return add_run(decomposed_, rule.source->span);
}

std::optional<RunId> LsysSuccessors::add_run(std::span<const ModuleId> run, Span place) {
    if (runs_.has_room(run.size())) return runs_.add(run);
    diagnostics_.error(place, fmt::format("in one step, different modules become more than {} modules",
                                          ModuleRuns::most_modules));
    return std::nullopt;
}

} // namespace graftal
