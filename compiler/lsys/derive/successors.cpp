#include "compiler/lsys/derive/successors.h"

#include <algorithm>

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
    const bool has_contexts = contexts(module).sight != Sight::none;
    if (!has_contexts) {
        if (!compete(module, [&](Outcome& outcome) { return enter(outcome, std::span(&module, 1)); }))
            return unknown;
        if (!competing_.empty()) return entry_of_competing(choices_);
    }
    const auto run = add_run(std::span(&module, 1), rewriter_.grammar().source->name.span);
    if (!run) return unknown;
    return has_contexts ? *run | mark : *run;
}

std::optional<LsysSuccessors::Replacement> LsysSuccessors::choose(ModuleId module, Entry entry,
                                                                  std::uint64_t draw, ContextMatcher& matcher,
                                                                  std::uint32_t position) {
    const std::vector<Outcome>* choices = &choices_;
    std::uint32_t modules = 1;
    const Sight sight = contexts(module).sight;
    if (sight == Sight::near) {
        entry = entry_nearby(module, entry, matcher, position);
    } else if (sight == Sight::far) {
        choices_here_.clear();
        entry = entry_in_context(module, entry, matcher, position, choices_here_);
        if (!competing_.empty()) modules = competing_.front().rule->length();
        choices = &choices_here_;
    }
    if (is_run(entry)) return Replacement{entry, modules};
    if (entry == unknown) return std::nullopt;
    const Winner<Outcome> winner = graftal::choose(choices->data() + (entry & ~mark), draw);
    const std::optional<RunId> run = run_of(winner);
    if (!run) return std::nullopt;
    return Replacement{*run, winner.entrant->rule->length()};
}

std::optional<RunId> LsysSuccessors::run_of(const Winner<Outcome>& winner) {
    constexpr RunId unknown_run = UINT32_MAX;
    const Outcome& outcome = *winner.entrant;
    const LsysRule& rule = *outcome.rule;
    if (rule.draws == 0) return outcome.run;
    const RuleDraw draw = winner.scattered();
    const std::span<const ModuleId> bound = std::span(bounds_).subspan(outcome.bound, outcome.bound_count);
    const auto drawn = [&]() -> std::optional<RunId> {
        values_of(bound);
        ModuleString successor;
        if (!rewriter_.append_successor(rule, values_, moment(bound.front()), draw, successor))
            return std::nullopt;
        return add_successor(successor, rule);
    };
    if (!rewriter_.is_pooled()) return drawn();
    forget_if_many(drawn_);
    RunId& known = drawn_.find_or_add(id_of(rule) * draw_sets + draw.set, bound, unknown_run);
    if (known != unknown_run) return known;
    const std::optional<RunId> run = drawn();
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
    return known = entry_in_context(module, entry, matcher, position, choices_);
}

LsysSuccessors::Entry LsysSuccessors::entry_in_context(ModuleId module, Entry entry, ContextMatcher& matcher,
                                                       std::uint32_t position,
                                                       std::vector<Outcome>& choices) {
    if (!compete(module, [&](Outcome& outcome) {
            bound_.assign(1, module);
            if (outcome.rule->sees_word() && !matcher.matches(*outcome.rule, position, bound_))
                return Fit::no;
            return enter_known(outcome, bound_);
        }))
        return unknown;
    return competing_.empty() ? entry & ~mark : entry_of_competing(choices);
}

/// The entry that the rules in competing_ give a module.
LsysSuccessors::Entry LsysSuccessors::entry_of_competing(std::vector<Outcome>& choices) const {
    if (!competing_.front().rule->is_random()) return competing_.front().run;
    const auto entry = static_cast<Entry>(choices.size() | mark);
    choices.insert(choices.end(), competing_.begin(), competing_.end());
    return entry;
}

/// Leaves what the rules that fit give in competing_.
template<typename Enter> bool LsysSuccessors::compete(ModuleId module, const Enter& enter) {
    const ModuleTable& modules = rewriter_.modules();
    return rewriter_.compete(RuleKind::produce, modules.symbol(module), modules.parameters(module).size(),
                             competing_, enter);
}

Fit LsysSuccessors::enter_known(Outcome& outcome, std::span<const ModuleId> bound) {
    forget_if_many(outcomes_);
    Outcome& known = outcomes_.find_or_add(id_of(*outcome.rule), bound, outcome);
    if (known.fit == Fit::error) known.fit = enter(known, bound);
    outcome = known;
    return outcome.fit;
}

/// Leaves the parameters of modules in values_.
void LsysSuccessors::values_of(std::span<const ModuleId> modules) {
    values_.clear();
    for (const ModuleId module : modules) {
        const auto parameters = rewriter_.modules().parameters(module);
        values_.insert(values_.end(), parameters.begin(), parameters.end());
    }
}

Fit LsysSuccessors::enter(Outcome& outcome, std::span<const ModuleId> bound) {
    values_of(bound);
    const LsysRule& rule = *outcome.rule;
    Alternative alternative{outcome, {}};
    const Fit fit = rewriter_.apply(alternative, values_, moment(bound.front()));
    if (fit != Fit::yes) return fit;
    outcome.probability = alternative.probability;
    if (rule.draws > 0) {
        outcome.bound = static_cast<std::uint32_t>(bounds_.size());
        outcome.bound_count = static_cast<std::uint32_t>(bound.size());
        bounds_.insert(bounds_.end(), bound.begin(), bound.end());
        return Fit::yes;
    }
    if (rule.keeps) alternative.successor.assign(1, bound.front());
    const std::optional<RunId> run = add_successor(alternative.successor, rule);
    if (!run) return Fit::error;
    outcome.run = *run;
    return Fit::yes;
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
