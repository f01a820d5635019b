// Productions that never apply. A fixpoint finds which modules can appear, by symbol and number of
// parameters, starting at the axiom.

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/compile/checks.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

/// Where a module appears.
enum class Place : std::uint8_t {
    made,  ///< in the axiom, or in what a step or decomposition gives: decompositions see it
    kept,  ///< in the word between two steps: derivation steps see it
    drawn, ///< in the last word, or in what interpretation gives
};

Place place_of(RuleKind kind) {
    return kind == RuleKind::produce ? Place::kept : kind == RuleKind::decompose ? Place::made : Place::drawn;
}

/// A module by its symbol and its number of parameters.
using Kind = std::pair<SymbolId, std::size_t>;

Kind kind_of(const LsysPattern& pattern) {
    return {pattern.symbol, pattern.arity};
}

/// A module that must appear before a production can apply.
struct Need {
    LsysPattern pattern;
    const LsysFormal* source = nullptr;
    bool context = false;
};

/// The value, if it is the same in every model: names stand for values that `--set` changes.
std::optional<double> literal_value(const std::optional<Expression>& expression) {
    const auto names = [](const Expression& e, const auto& self) -> bool {
        return e.kind == Expression::Kind::name || e.kind == Expression::Kind::element ||
               std::ranges::any_of(e.operands, [&](const Expression& o) { return self(o, self); });
    };
    if (!expression || names(*expression, names) || calls_chance(*expression)) return std::nullopt;
    Diagnostics ignored; // the grammar has compiled it
    return evaluate(*expression, {}, ignored);
}

class IdleProductions {
  public:
    IdleProductions(const LsysGrammar& grammar, const std::vector<LsysUse>& uses, Diagnostics& diagnostics)
        : grammar_(grammar), uses_(uses), diagnostics_(diagnostics), states_(grammar.rules.size()) {}

    std::set<SymbolId> run() && {
        for (const LsysUse& use : uses_)
            first_uses_.try_emplace({use.symbol, use.arity}, &use);
        for (std::size_t rule = 0; rule < states_.size(); ++rule)
            states_[rule] = state_of(grammar_.rules[rule]);
        for (std::size_t kind = 0; kind < rule_kind_count; ++kind)
            for (const auto& rules : grammar_.rules_of[kind])
                find_hidden(rules);
        for (const LsysTemplate& module : grammar_.axiom)
            appear(module, Place::made);
        for (std::uint32_t rule = 0; rule < states_.size(); ++rule)
            advance(rule);
        while (!fresh_.empty()) {
            const std::vector<std::uint32_t> rules = std::exchange(fresh_.back(), {});
            fresh_.pop_back();
            std::ranges::for_each(rules, [&](std::uint32_t rule) { advance(rule); });
        }
        std::size_t reported = 0;
        for (std::size_t rule = 0; rule < states_.size() && reported < Diagnostics::max_errors; ++rule) {
            if (states_[rule].applies) continue;
            report(*grammar_.rules[rule].source, states_[rule]);
            ++reported;
        }
        return std::move(miscounted_);
    }

  private:
    struct State {
        std::vector<Need> needs;
        std::size_t met = 0; ///< number of its first needs that are met
        const LsysRule* hidden_by = nullptr;
        bool is_false = false;  ///< its condition
        bool no_chance = false; ///< by its probability
        bool applies = false;
    };

    static State state_of(const LsysRule& rule) {
        State state;
        state.is_false = literal_value(rule.source->condition) == 0.0;
        state.no_chance = literal_value(rule.source->probability) == 0.0;
        state.needs.push_back({rule.predecessor, &rule.source->predecessor});
        const auto add = [&](const std::vector<LsysPattern>& patterns, const std::vector<LsysFormal>& sources,
                             bool context) {
            for (std::size_t i = 0; i < patterns.size(); ++i)
                state.needs.push_back({patterns[i], &sources[i], context});
        };
        add(rule.following, rule.source->following, false);
        add(rule.left, rule.source->left, true);
        add(rule.right, rule.source->right, true);
        return state;
    }

    /// Whether a production fits each module of its symbol and number of parameters.
    static bool always_fits(const LsysRule& rule) {
        return !rule.sees_word() && (!rule.source->condition || literal_value(rule.source->condition) > 0.0);
    }

    /// A production that always fits ends the search for others, except those with probabilities like it.
    void find_hidden(const std::vector<std::uint32_t>& rules) {
        std::map<std::size_t, const LsysRule*> first; // by the number of parameters
        for (const std::uint32_t id : rules) {
            const LsysRule& rule = grammar_.rules[id];
            const auto known = first.find(rule.predecessor.arity);
            if (known == first.end()) {
                if (always_fits(rule)) first.emplace(rule.predecessor.arity, &rule);
            } else if (!known->second->probability || !rule.probability) {
                states_[id].hidden_by = known->second;
            }
        }
        for (const auto& [arity, rule] : first)
            if (rule->kind == RuleKind::decompose)
                decomposed_.emplace(Kind{rule->predecessor.symbol, arity}, rule);
    }

    void appear(const LsysTemplate& module, Place place) {
        appear(Kind{module.symbol, module.parameters.size()}, place);
    }

    void appear(const Kind& kind, Place place) {
        if (!seen_.emplace(kind, place).second) return;
        if (const auto waiting = waiting_.find({kind, place}); waiting != waiting_.end()) {
            fresh_.push_back(std::move(waiting->second));
            waiting_.erase(waiting);
        }
        if (place == Place::made && !decomposed_.contains(kind)) appear(kind, Place::kept);
        if (place == Place::kept) appear(kind, Place::drawn);
    }

    bool seen(const Kind& kind, Place place) const { return seen_.contains({kind, place}); }
    bool is_skipped(const Need& need) const {
        return need.context && grammar_.ignored[need.pattern.symbol] &&
               !is_bracket(grammar_, need.pattern.symbol);
    }

    /// Meets the needs of a production in their order, as far as the modules known so far do.
    void advance(std::uint32_t id) {
        const LsysRule& rule = grammar_.rules[id];
        State& state = states_[id];
        if (state.applies || state.hidden_by || state.is_false || state.no_chance) return;
        const Place place = place_of(rule.kind);
        for (; state.met < state.needs.size(); ++state.met) {
            const Need& need = state.needs[state.met];
            if (is_skipped(need)) return;
            if (is_bracket(grammar_, need.pattern.symbol) || seen(kind_of(need.pattern), place)) continue;
            waiting_[{kind_of(need.pattern), place}].push_back(id);
            return;
        }
        state.applies = true;
        for (const LsysTemplate& module : rule.successor)
            appear(module, rule.kind == RuleKind::interpret ? Place::drawn : Place::made);
    }

    Diagnostic& warn(Span span, std::string_view reason) {
        return diagnostics_.warning(span, fmt::format("this production never applies: {}", reason));
    }

    void report(const LsysProduction& source, const State& state) {
        if (state.hidden_by) {
            const bool chance = state.hidden_by->probability.has_value();
            warn(source.span, chance ? "those with probabilities apply to each such module"
                                     : "an earlier one applies to each such module")
                .with_hint(chance ? "give it a probability too: A -> B : 0.5"
                                  : "give the earlier one a condition, or each a probability: A -> B : 0.5")
                .with_note(state.hidden_by->source->span, "the earlier one is here");
        } else if (state.is_false) {
            warn(source.condition->span, "its condition is never true")
                .with_hint("compare a parameter, a variable, 'step' or 'age'");
        } else if (state.no_chance) {
            warn(source.probability->span, "its probability is 0")
                .with_hint("remove it, or give it a chance");
        } else {
            report_unmet(state.needs[state.met]);
        }
    }

    void report_unmet(const Need& need) {
        const Span span = need.source->span;
        const Kind kind = kind_of(need.pattern);
        const std::string name(need.source->symbol);
        const std::string module = fmt::format("'{}'", name);
        if (is_skipped(need)) {
            warn(span, fmt::format("contexts skip {}", module))
                .with_hint("leave it out here, or change the list of 'ignore' or 'consider'");
        } else if (const auto decomposed = decomposed_.find(kind);
                   decomposed != decomposed_.end() && seen(kind, Place::made)) {
            warn(span, fmt::format("'decompose' replaces each {} before", module))
                .with_hint("write it under 'decompose' too, or give that production a condition")
                .with_note(decomposed->second->source->span, "that production is here");
        } else if (seen(kind, Place::drawn)) {
            warn(span, fmt::format("only 'interpret' makes {}", module))
                .with_hint("write it under 'interpret' too");
        } else if (const LsysUse* const other = other_use(kind)) {
            miscounted_.insert(kind.first);
            warn(span, fmt::format("no {} with {} appears", module, parameter_count(kind.second)))
                .with_hint("write as many parameters before the arrow as the module has elsewhere")
                .with_note(other->span, fmt::format("here {} has {}", module, parameter_count(other->arity)));
        } else if (first_uses_.contains(kind)) {
            warn(span, fmt::format("only productions that never apply make {}", module))
                .with_hint("mend those first");
        } else {
            const std::string meant = did_you_mean(name, appearing());
            warn(span, fmt::format("no axiom or successor has a module {}", module))
                .with_hint(meant.empty() ? fmt::format("write {} in the axiom or a successor, or remove the "
                                                       "production",
                                                       module)
                                         : meant);
        }
    }

    /// A use of the same symbol with another number of parameters, by a module that appears.
    const LsysUse* other_use(const Kind& kind) const {
        for (auto use = first_uses_.lower_bound({kind.first, 0});
             use != first_uses_.end() && use->first.first == kind.first; ++use)
            if (use->first != kind && seen(use->first, Place::drawn)) return use->second;
        return nullptr;
    }

    /// Symbols of modules that no production rewrites: one may be the misspelt one.
    std::vector<std::string> appearing() const {
        std::vector<std::string> names;
        for (const auto& [kind, use] : first_uses_)
            if (!grammar_.is_rewritten(kind.first)) names.push_back(grammar_.symbols[kind.first]);
        return names;
    }

    const LsysGrammar& grammar_;
    const std::vector<LsysUse>& uses_;
    Diagnostics& diagnostics_;
    std::vector<State> states_; ///< of the rules
    std::map<Kind, const LsysUse*> first_uses_;
    std::map<Kind, const LsysRule*> decomposed_; ///< by the rule that replaces all of them
    std::set<std::pair<Kind, Place>> seen_;
    std::map<std::pair<Kind, Place>, std::vector<std::uint32_t>> waiting_; ///< rules
    std::vector<std::vector<std::uint32_t>> fresh_;                        ///< rules that waited
    std::set<SymbolId> miscounted_;
};

} // namespace

std::set<SymbolId> warn_of_idle_productions(const LsysGrammar& grammar, const std::vector<LsysUse>& uses,
                                            Diagnostics& diagnostics) {
    return IdleProductions(grammar, uses, diagnostics).run();
}

} // namespace graftal
