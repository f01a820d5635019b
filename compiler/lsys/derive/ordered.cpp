#include "compiler/lsys/derive/ordered.h"

#include <utility>

namespace graftal {

LsysOrderedDeriver::LsysOrderedDeriver(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t seed,
                                       std::uint64_t max_modules)
    : rewriter_(rewriter), diagnostics_(diagnostics), random_(seed), max_modules_(max_modules),
      matcher_(rewriter.grammar(), rewriter.modules()), has_cuts_(has_cuts(rewriter.grammar())),
      decomposes_(rewriter.grammar().has_rules(RuleKind::decompose)) {}

std::optional<ModuleString> LsysOrderedDeriver::derive(unsigned steps) {
    const bool derived = derive_to(steps);
    rewriter_.set_birth(ModuleTable::no_birth);
    rewriter_.derive_in_order(nullptr);
    if (!derived) return std::nullopt;
    next_ = {};
    return std::exchange(word_, {});
}

bool LsysOrderedDeriver::derive_to(unsigned steps) {
    if (!begin()) return false;
    LsysVariables& variables = rewriter_.variables();
    for (step_ = 1; step_ <= steps; ++step_) {
        if (!variables.start_each(step_) || !step() || !variables.end_each(step_)) return false;
        if (step_ == steps && !variables.end(steps)) return false;
        if (stage_ && !stage_(step_, word_)) return false;
    }
    return true;
}

bool LsysOrderedDeriver::begin() {
    step_ = 0;
    chance_.emplace(random_.sequence(0));
    rewriter_.set_birth(0);
    rewriter_.derive_in_order(&*chance_);
    if (!rewriter_.variables().start()) return false;
    std::optional<ModuleString> axiom = rewriter_.axiom();
    if (!axiom) return false;
    next_.clear();
    if (decomposes_ && !decompose(*axiom)) return false;
    word_.swap(decomposes_ ? next_ : *axiom);
    if (has_cuts_) cut_branches(rewriter_.grammar(), rewriter_.modules(), word_);
    return !stage_ || stage_(0, word_);
}

bool LsysOrderedDeriver::step() {
    chance_.emplace(random_.sequence(step_));
    rewriter_.set_birth(step_);
    matcher_.look_at(word_);
    next_.clear();
    for (std::uint32_t at = 0; at < word_.size();) {
        std::uint32_t consumed = 1;
        if (!rewrite(at, consumed)) return false;
        at += consumed;
    }
    word_.swap(next_);
    if (has_cuts_) cut_branches(rewriter_.grammar(), rewriter_.modules(), word_);
    return true;
}

/// Adds to the next word what becomes of the modules at a place.
bool LsysOrderedDeriver::rewrite(std::uint32_t position, std::uint32_t& consumed) {
    rewriter_.work();
    Moment moment;
    const auto rule = choose(RuleKind::produce, word_[position], position, moment);
    if (!rule) return false;
    if (*rule) consumed = (*rule)->length();
    ModuleString& string = decomposes_ ? successor_ : next_;
    if (decomposes_) successor_.clear();
    if (!*rule)
        string.push_back(word_[position]);
    else if (!rewriter_.append_by(**rule, moment, slots_, string))
        return false;
    if (decomposes_) return decompose(successor_);
    return is_short_enough(rewriter_.grammar(), next_.size(), max_modules_, step_, diagnostics_);
}

/// Adds a string to the next word, decomposed.
bool LsysOrderedDeriver::decompose(const ModuleString& string) {
    const LsysGrammar& grammar = rewriter_.grammar();
    std::uint64_t applied = 0;
    pending_.clear();
    for (auto module = string.rbegin(); module != string.rend(); ++module)
        pending_.push_back({*module, 0});
    while (!pending_.empty()) {
        const auto [next, depth] = pending_.back();
        pending_.pop_back();
        const std::uint64_t length = next_.size() + pending_.size() + 1;
        if (!is_short_enough(grammar, length, max_modules_, step_, diagnostics_)) return false;
        rewriter_.work();
        Moment moment;
        const auto by = choose(RuleKind::decompose, next, std::nullopt, moment);
        if (!by) return false;
        if (!*by) {
            next_.push_back(next);
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
std::optional<const LsysRule*> LsysOrderedDeriver::choose(RuleKind kind, ModuleId module,
                                                          std::optional<std::uint32_t> position,
                                                          Moment& moment) {
    const LsysGrammar& grammar = rewriter_.grammar();
    const ModuleTable& modules = rewriter_.modules();
    if (!grammar.has_rules(kind, modules.symbol(module))) return nullptr;
    moment = moment_of(step_, modules.birth(module));
    candidate_count_ = 0;
    const auto first = rewriter_.try_rules(grammar.candidates(kind, modules.symbol(module)),
                                           modules.parameters(module).size(), [&](const LsysRule& rule) {
                                               bound_.assign(1, module);
                                               if (rule.sees_word() &&
                                                   !(position && matcher_.matches(rule, *position, bound_)))
                                                   return Fit::no;
                                               return attempt(rule, moment);
                                           });
    if (!first || !*first) return first;
    Candidate* const chosen = chosen_of(**first);
    if (!chosen) return std::nullopt;
    const LsysRule& rule = *chosen->rule;
    slots_.swap(chosen->slots);
    const auto set = static_cast<std::uint32_t>(rule.draws > 0 ? chance_->draw() % draw_sets : 0);
    if (!rewriter_.apply_slots(rule, moment, set, slots_)) return std::nullopt;
    return &rule;
}

/// Tries a production on the modules in bound_, and leaves it as a candidate if it fits.
Fit LsysOrderedDeriver::attempt(const LsysRule& rule, const Moment& moment) {
    if (candidates_.size() == candidate_count_) candidates_.emplace_back();
    Candidate& candidate = candidates_[candidate_count_];
    candidate.rule = &rule;
    candidate.slots.clear();
    for (const ModuleId bound : bound_) {
        const auto parameters = rewriter_.modules().parameters(bound);
        candidate.slots.insert(candidate.slots.end(), parameters.begin(), parameters.end());
    }
    if (!rewriter_.try_slots(rule, moment, candidate.slots)) return Fit::error;
    if (rule.condition) rule.condition->refill(candidate.slots, *chance_);
    const std::optional<bool> fits = rewriter_.holds(rule, moment, candidate.slots);
    if (!fits) return Fit::error;
    if (!*fits) return Fit::no;
    const std::optional<double> probability = rewriter_.probability_of(rule, moment, candidate.slots);
    if (!probability) return Fit::error;
    candidate.probability = *probability;
    ++candidate_count_;
    return Fit::yes;
}

/// Null after an error.
LsysOrderedDeriver::Candidate* LsysOrderedDeriver::chosen_of(const LsysRule& first) {
    if (!first.probability) return &candidates_.front();
    double sum = 0;
    for (std::size_t i = 0; i < candidate_count_; ++i)
        sum += candidates_[i].probability;
    if (!rewriter_.sums_to_one(sum, first)) return nullptr;
    double share = chance_->unit() * sum;
    Candidate* chosen = nullptr;
    for (std::size_t i = 0; i < candidate_count_; ++i) {
        Candidate& candidate = candidates_[i];
        if (candidate.probability == 0) continue;
        chosen = &candidate;
        share -= candidate.probability;
        if (share < 0) break;
    }
    return chosen;
}

} // namespace graftal
