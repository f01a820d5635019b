#include "compiler/lsys/derive/ordered.h"

#include "compiler/lsys/derive/word.h"

namespace graftal {

bool LsysOrderedRewriter::begin_step(unsigned step, const CounterRandom& random) {
    step_ = step;
    chance_.emplace(random);
    rewriter_.derive_in_order(&*chance_);
    LsysVariables& variables = rewriter_.variables();
    return step == 0 ? variables.start() : variables.start_each(step);
}

bool LsysOrderedRewriter::end_step(bool is_last) {
    LsysVariables& variables = rewriter_.variables();
    return step_ == 0 || (variables.end_each(step_) && (!is_last || variables.end(step_)));
}

bool LsysOrderedRewriter::rewrite(const ModuleString& word, ModuleString& next) {
    for (std::uint32_t at = 0; at < word.size();) {
        rewriter_.work();
        Moment moment;
        const auto rule = choose_rule(RuleKind::produce, word[at], at, moment);
        if (!rule) return false;
        ModuleString& string = decomposes_ ? successor_ : next;
        if (decomposes_) successor_.clear();
        if (!*rule || (*rule)->keeps)
            string.push_back(word[at]);
        else if (!rewriter_.append_by(**rule, moment, slots_, string))
            return false;
        if (decomposes_
                ? !decompose(successor_, next)
                : !is_short_enough(rewriter_.grammar(), next.size(), max_modules_, step_, diagnostics_))
            return false;
        at += *rule ? (*rule)->length() : 1;
    }
    return true;
}

bool LsysOrderedRewriter::decompose(const ModuleString& string, ModuleString& out) {
    const LsysGrammar& grammar = rewriter_.grammar();
    std::uint64_t applied = 0;
    pending_.clear();
    for (auto module = string.rbegin(); module != string.rend(); ++module)
        pending_.push_back({*module, 0});
    while (!pending_.empty()) {
        const auto [next, depth] = pending_.back();
        pending_.pop_back();
        const std::uint64_t length = out.size() + pending_.size() + 1;
        if (!is_short_enough(grammar, length, max_modules_, step_, diagnostics_)) return false;
        rewriter_.work();
        Moment moment;
        const auto by = choose_rule(RuleKind::decompose, next, std::nullopt, moment);
        if (!by) return false;
        if (!*by) {
            out.push_back(next);
            continue;
        }
        if (depth == max_decomposition_depth || ++applied > max_modules_)
            return refuse_decomposition(grammar, **by, "does not end", max_modules_, diagnostics_);
        parts_.clear();
        if (!rewriter_.append_by(**by, moment, slots_, parts_)) return false;
        for (auto part = parts_.rbegin(); part != parts_.rend(); ++part)
            pending_.push_back({*part, depth + 1});
    }
    return true;
}

/// The production for a module, null if none fits, nothing after an error. Leaves its slots, with all that it
/// assigns, in slots_. `position`: in the word, where contexts count.
std::optional<const LsysRule*> LsysOrderedRewriter::choose_rule(RuleKind kind, ModuleId module,
                                                                std::optional<std::uint32_t> position,
                                                                Moment& moment) {
    const ModuleTable& modules = rewriter_.modules();
    moment = moment_of(step_, modules.birth(module));
    slots_.clear();
    const bool fit = rewriter_.compete(kind, modules.symbol(module), modules.parameters(module).size(),
                                       candidates_, [&](Candidate& candidate) {
                                           const LsysRule& rule = *candidate.rule;
                                           bound_.assign(1, module);
                                           if (rule.sees_word() &&
                                               !(position && matcher_.matches(rule, *position, bound_)))
                                               return Fit::no;
                                           return enter(candidate, moment);
                                       });
    if (!fit) return std::nullopt;
    if (candidates_.empty()) return nullptr;
    const std::uint64_t draw = candidates_.front().rule->probability ? chance_->draw() : 0;
    const Candidate& chosen = *choose(candidates_.data(), draw).entrant;
    const LsysRule& rule = *chosen.rule;
    slots_.resize(chosen.slots + rule.slot_count());
    slots_.erase(slots_.begin(), slots_.begin() + static_cast<std::ptrdiff_t>(chosen.slots));
    const std::uint64_t own = rule.draws > 0 ? chance_->draw() : 0;
    const RuleDraw numbers{static_cast<std::uint32_t>(own % draw_sets), own};
    if (!rewriter_.apply_slots(rule, moment, numbers, slots_)) return std::nullopt;
    return &rule;
}

/// Tries a production on the modules in bound_, and leaves its slots if it fits.
Fit LsysOrderedRewriter::enter(Candidate& candidate, const Moment& moment) {
    const LsysRule& rule = *candidate.rule;
    candidate.slots = slots_.size();
    for (const ModuleId bound : bound_) {
        const auto parameters = rewriter_.modules().parameters(bound);
        slots_.insert(slots_.end(), parameters.begin(), parameters.end());
    }
    if (!rewriter_.try_slots(rule, moment, slots_, candidate.slots)) return Fit::error;
    const std::span<double> slots = std::span(slots_).subspan(candidate.slots);
    if (rule.condition) rule.condition->refill(slots, *chance_);
    const Fit fit = rewriter_.enter(candidate, moment, slots);
    if (fit == Fit::no) slots_.resize(candidate.slots);
    return fit;
}

} // namespace graftal
