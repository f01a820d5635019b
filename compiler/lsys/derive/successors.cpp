#include "compiler/lsys/derive/successors.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/support/counter_random.h"

namespace graftal {

namespace {

constexpr std::size_t most_known_keys = 1u << 22;
constexpr std::size_t most_kept_modules = 1u << 28; ///< of runs, and choices, from one step to the next

template<typename Value> void forget_if_many(ModuleKeys<Value>& keys) {
    if (keys.size() + keys.module_count() / 8 >= most_known_keys) keys.clear();
}

} // namespace

LsysSuccessors::LsysSuccessors(LsysRewriter& rewriter, LsysDecomposer& decomposer, Diagnostics& diagnostics)
    : rewriter_(rewriter), decomposer_(decomposer), diagnostics_(diagnostics),
      contexts_(rewriter.grammar().symbols.size()) {
    const LsysGrammar& grammar = rewriter.grammar();
    is_timed_ =
        grammar.time(RuleKind::produce) != 0 || std::ranges::find(grammar.ages, true) != grammar.ages.end();
    for (const auto& rules : grammar.rules_of[static_cast<std::size_t>(RuleKind::produce)])
        for (const std::uint32_t id : rules)
            look_at(grammar.rules[id]);
}

void LsysSuccessors::look_at(const LsysRule& rule) {
    is_stochastic_ |= rule.is_random();
    if (!rule.sees_word()) return;
    sees_word_ = true;
    Contexts& contexts = contexts_[rule.predecessor.symbol];
    contexts.has_left |= !rule.left.empty();
    contexts.has_right |= !rule.right.empty();
    // A pattern in brackets has three modules at least, or sees whether there is a branch.
    const bool near = rule.left.size() <= 1 && rule.right.size() <= 1 && rule.following.empty();
    contexts.sight = std::max(contexts.sight, near ? Sight::near : Sight::far);
}

void LsysSuccessors::begin_step(std::uint32_t step) {
    step_ = step;
    if (!is_timed_ && runs_.size() + choices_.size() + bounds_.size() <= most_kept_modules) return;
    runs_.clear();
    entries_.clear();
    choices_.clear();
    bounds_.clear();
    nearby_.clear();
    outcomes_.clear();
    drawn_.clear();
}

Moment LsysSuccessors::moment(ModuleId module) const {
    return moment_of(step_, rewriter_.modules().birth(module));
}

LsysSuccessors::Entry LsysSuccessors::compute(ModuleId module) {
    const Entry entry = compute_entry(module);
    if (entries_.size() <= module) entries_.resize(rewriter_.modules().size(), unknown);
    return entries_[module] = entry;
}

/// The entry of a module: where contexts decide, the run that leaves the module as it is, with the mark.
LsysSuccessors::Entry LsysSuccessors::compute_entry(ModuleId module) {
    std::optional<const LsysRule*> first = nullptr;
    const bool has_contexts = contexts(module).sight != Sight::none;
    if (!has_contexts)
        first = compete(module, [&](const LsysRule& rule) { return outcome(rule, std::span(&module, 1)); });
    if (!first) return unknown;
    if (*first) return entry_of(*first, 0, choices_);
    const auto run = add_run(std::span(&module, 1), rewriter_.grammar().source->name.span);
    if (!run) return unknown;
    return has_contexts ? *run | mark : *run;
}

std::optional<LsysSuccessors::Replacement> LsysSuccessors::choose(ModuleId module, Entry entry,
                                                                  std::uint64_t draw, ContextMatcher& matcher,
                                                                  std::uint32_t position) {
    const std::vector<Choice>* choices = &choices_;
    std::uint32_t modules = 1;
    const Sight sight = contexts(module).sight;
    if (sight == Sight::near) {
        entry = entry_nearby(module, entry, matcher, position);
    } else if (sight == Sight::far) {
        const auto first = compete_in_context(module, matcher, position);
        chances_.clear();
        entry = first ? entry_of(*first, entry & ~mark, chances_) : unknown;
        if (first && *first) modules = (*first)->length();
        choices = &chances_;
    }
    if (is_run(entry)) return Replacement{entry, modules};
    if (entry == unknown) return std::nullopt;
    const Choice* choice = choices->data() + (entry & ~mark);
    std::uint64_t below = 0;
    while (draw > choice->upto)
        below = (choice++)->upto;
    const std::optional<RunId> run = run_of(*choice, draw - below);
    if (!run) return std::nullopt;
    return Replacement{*run, choice->modules};
}

/// The run of a choice. Chance within a choice has nothing to do with the choice itself.
std::optional<RunId> LsysSuccessors::run_of(const Choice& choice, std::uint64_t draw) {
    constexpr RunId unknown_run = UINT32_MAX;
    if (!choice.draws) return choice.run;
    const LsysRule& rule = *choice.draws;
    const auto id = static_cast<std::uint32_t>(&rule - rewriter_.grammar().rules.data());
    const auto set = static_cast<std::uint32_t>(CounterRandom::scrambled(draw) % draw_sets);
    forget_if_many(drawn_);
    const std::span<const ModuleId> bound = std::span(bounds_).subspan(choice.bound, choice.bound_count);
    RunId& known = drawn_.find_or_add(id * draw_sets + set, bound, unknown_run);
    if (known != unknown_run) return known;
    values_of(bound);
    ModuleString successor;
    if (!rewriter_.append_successor(rule, values_, moment(bound.front()), set, successor))
        return std::nullopt;
    const std::optional<RunId> run = add_successor(successor, rule);
    if (run) known = *run;
    return run;
}

/// The neighbours decide; so each combination of them is tried once.
LsysSuccessors::Entry LsysSuccessors::entry_nearby(ModuleId module, Entry entry, ContextMatcher& matcher,
                                                   std::uint32_t position) {
    const Contexts& seen = contexts(module);
    const ModuleId key[] = {seen.has_left ? matcher.before(position) : ContextLinks::none, module,
                            seen.has_right ? matcher.after(position) : ContextLinks::none};
    forget_if_many(nearby_);
    Entry& known = nearby_.find_or_add(0, key, unknown);
    if (known != unknown) return known;
    const auto first = compete_in_context(module, matcher, position);
    return known = first ? entry_of(*first, entry & ~mark, choices_) : unknown;
}

std::optional<const LsysRule*> LsysSuccessors::compete_in_context(ModuleId module, ContextMatcher& matcher,
                                                                  std::uint32_t position) {
    return compete(module, [&](const LsysRule& rule) {
        bound_.assign(1, module);
        if (rule.sees_word() && !matcher.matches(rule, position, bound_)) return Outcome{};
        return known_outcome(rule, bound_);
    });
}

/// The entry that the rules in competing_ give a module; `stays` if there are none.
LsysSuccessors::Entry LsysSuccessors::entry_of(const LsysRule* first, RunId stays,
                                               std::vector<Choice>& choices) {
    if (!first) return stays;
    if (!first->is_random()) return competing_.front().run;
    const auto entry = static_cast<Entry>(choices.size() | mark);
    return add_choices(*first, choices) ? entry : unknown;
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
        choices.push_back({upto < 0x1p64 ? static_cast<std::uint64_t>(upto) : UINT64_MAX, outcome.run,
                           outcome.draws, outcome.bound, outcome.bound_count, outcome.modules});
    }
    choices.back().upto = UINT64_MAX;
    return true;
}

LsysSuccessors::Outcome LsysSuccessors::known_outcome(const LsysRule& rule, std::span<const ModuleId> bound) {
    forget_if_many(outcomes_);
    const auto id = static_cast<std::uint32_t>(&rule - rewriter_.grammar().rules.data());
    Outcome& known = outcomes_.find_or_add(id, bound, {Fit::error});
    if (known.fit == Fit::error) known = outcome(rule, bound);
    return known;
}

/// Leaves the parameters of modules in values_.
void LsysSuccessors::values_of(std::span<const ModuleId> modules) {
    values_.clear();
    for (const ModuleId module : modules) {
        const auto parameters = rewriter_.modules().parameters(module);
        values_.insert(values_.end(), parameters.begin(), parameters.end());
    }
}

LsysSuccessors::Outcome LsysSuccessors::outcome(const LsysRule& rule, std::span<const ModuleId> bound) {
    values_of(bound);
    const Fit fit = rewriter_.apply(rule, values_, moment(bound.front()), alternative_);
    if (fit != Fit::yes) return {fit};
    if (rule.draws > 0) {
        bounds_.insert(bounds_.end(), bound.begin(), bound.end());
        const auto count = static_cast<std::uint32_t>(bound.size());
        return {Fit::yes,
                alternative_.probability,
                0,
                &rule,
                static_cast<std::uint32_t>(bounds_.size()) - count,
                count,
                rule.length()};
    }
    const std::optional<RunId> run = add_successor(alternative_.successor, rule);
    if (!run) return {Fit::error};
    return {Fit::yes, alternative_.probability, *run, nullptr, 0, 0, rule.length()};
}

/// Decomposes the run for good where it can be decomposed in one way only.
std::optional<RunId> LsysSuccessors::add_successor(const ModuleString& successor, const LsysRule& rule) {
    if (!decomposer_.has_rules() || decomposer_.varies()) return add_run(successor, rule.source->span);
    decomposed_.clear();
    if (!decomposer_.run(successor, CounterRandom(0), decomposed_)) return std::nullopt;
    return add_run(decomposed_, rule.source->span);
}

std::optional<RunId> LsysSuccessors::add_run(std::span<const ModuleId> run, Span place) {
    if (runs_.has_room(run.size())) return runs_.add(run);
    diagnostics_.error(
        place, fmt::format("in one step, the successors of different modules have more than {} modules",
                           ModuleRuns::most_modules));
    return std::nullopt;
}

} // namespace graftal
