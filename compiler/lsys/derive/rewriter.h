#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/compile/module_table.h"
#include "compiler/lsys/compile/program.h"
#include "compiler/lsys/derive/competition.h"
#include "compiler/lsys/derive/variables.h"
#include "compiler/support/control.h"
#include "compiler/support/id_table.h"
#include "compiler/support/stage_price.h"

namespace graftal {

/// A rule that a module may be rewritten by.
struct Alternative : Competitor {
    ModuleString successor; ///< empty where the rule draws random numbers: see LsysRewriter::successor()
};

/// When rules are tried; for those that read it.
struct Moment {
    double step = 0; ///< the step being carried out; when drawing: those done
    double age = 0;  ///< of the module
};

/// The moment of a module that came into being in step `birth`, if that is known.
inline Moment moment_of(std::uint32_t step, std::uint32_t birth) {
    return {static_cast<double>(step),
            birth == ModuleTable::no_birth ? 0.0 : static_cast<double>(step - birth)};
}

/// The result of trying a rule on a module.
enum class Fit : std::uint8_t { no, yes, error };

/// The different modules of one derivation may not be more.
inline constexpr std::size_t max_distinct_modules = 20'000'000;

/// Applies the productions of a grammar to single modules; each module is rewritten once and then known.
class LsysRewriter {
  public:
    /// All must outlive this. The meter counts what work() is told; null: nobody does. `most_instructions`:
    /// of all blocks.
    LsysRewriter(const LsysGrammar& grammar, Diagnostics& diagnostics, std::uint64_t seed = 0,
                 WorkMeter* meter = nullptr, std::uint64_t most_instructions = max_instructions)
        : grammar_(grammar), diagnostics_(diagnostics), seed_(seed), meter_(meter),
          machine_(grammar.lets, diagnostics, meter, most_instructions),
          variables_(grammar, machine_, diagnostics, seed),
          has_ages_(std::ranges::find(grammar.ages, true) != grammar.ages.end()) {}

    const LsysGrammar& grammar() const { return grammar_; }
    ModuleTable& modules() { return modules_; }
    const ModuleTable& modules() const { return modules_; }

    /// Counts modules that a user of this has looked at to derive or draw.
    void work(std::uint64_t modules = 1) const {
        if (meter_) meter_->add(modules, StagePrice::module);
    }
    /// Counts a module that a user of this has drawn by itself.
    void work_of_drawing() const {
        if (meter_) meter_->add(1, StagePrice::drawn_module);
    }
    /// Counts a part with this many instances that a user of this has composed.
    void work_of_part(std::size_t instances) const {
        if (meter_)
            meter_->add(1, StagePrice::part + StagePrice::part_instance * static_cast<double>(instances));
    }
    /// The seconds of work that are left.
    double work_left() const { return meter_ ? meter_->left() : StageWork::unlimited; }

    /// Readies the variables for a derivation of this many steps; to be called before anything else is.
    /// False after an error. O(1) where there are none.
    bool prepare(unsigned steps);
    LsysVariables& variables() { return variables_; }
    /// Where the word is derived in order, from now on until it is null: where chance is drawn anew. Then
    /// productions may change the variables.
    void derive_in_order(LsysChance* chance) { chance_ = chance; }

    /// From now on each module has random numbers of its own, rather than one of the draw_sets.
    void use_no_pool() { pooled_ = false; }
    bool is_pooled() const { return pooled_; }

    /// The modules of the axiom; nothing after an error.
    std::optional<ModuleString> axiom();

    /// The alternatives of a module by itself: productions that see more of the word are passed over.
    /// They share all draws; none: no production applies, and the module stays. Null after an error
    /// (a division by zero, probabilities that do not sum to 1); reported once. Valid as long as this.
    const std::vector<Alternative>* alternatives(RuleKind kind, ModuleId module, const Moment& moment);

    /// Whether alternatives() would give any, or an error.
    bool is_rewritten(RuleKind kind, ModuleId module, const Moment& moment);

    /// The successor of an alternative of a module, with the random numbers of a draw. Valid until the next
    /// call; null after an error.
    const ModuleString* successor(const Alternative& alternative, ModuleId module, const Moment& moment,
                                  RuleDraw draw);

    /// From now on modules of `ages` symbols are told apart by the step in which they came into being; but
    /// not what they are drawn as. `no_birth`: no longer.
    void set_birth(std::uint32_t step) { birth_ = step; }

    /// The steps of applying a rule, for callers that keep its slots. `slots` has the values of its
    /// variables, from `first` on and last, and gets what else the rule's condition knows. Once applied, it
    /// gets the random numbers of a draw, and the assignments of the second block. False after an error.
    bool try_slots(const LsysRule& rule, const Moment& moment, std::vector<double>& slots,
                   std::size_t first = 0);
    bool apply_slots(const LsysRule& rule, const Moment& moment, RuleDraw draw, std::vector<double>& slots,
                     std::size_t first = 0);
    /// Tries the condition of a rule whose slots are ready. If it holds, sets the competitor's probability.
    Fit enter(Competitor& competitor, const Moment& moment, std::span<const double> slots);
    /// Tries the condition for the values of the rule's variables, those of contexts included.
    Fit enter_values(Competitor& competitor, std::span<const double> values, const Moment& moment);
    bool append_by(const LsysRule& rule, const Moment& moment, std::span<const double> slots,
                   ModuleString& string);

    /// The variables as expressions of rules of a kind see them.
    std::span<const double> cells(RuleKind kind, double step) const {
        return grammar_.first_cells.empty() ? std::span<const double>() : known_cells(kind, step);
    }

    /// Adds the rule's successor to `string`, with the random numbers of a draw; false after an error.
    bool append_successor(const LsysRule& rule, std::span<const double> values, const Moment& moment,
                          RuleDraw draw, ModuleString& string);
    /// Tries the alternative's rule and, if it fits, says what it gives. Leaves random numbers to
    /// successor().
    Fit apply(Alternative& alternative, std::span<const double> values, const Moment& moment);

    /// The rules that may rewrite a module of this many parameters, as competitors that share all draws; none
    /// if none fits. The first that fits decides: without a probability it is the only one; with one, all
    /// others that fit and have one compete; what they leave below 1 leaves the module as it is. Calls
    /// `enter(entrant)` for each, which gives a Fit and sets the entrant's probability. False after an error.
    template<typename Entrant, typename Enter>
    bool compete(RuleKind kind, SymbolId symbol, std::size_t arity, std::vector<Entrant>& entrants,
                 const Enter& enter);

    /// The pool of a rule: for each call the number of each set, call by call.
    const std::vector<double>& draws_of(const LsysRule& rule);

    /// The value of an expression of a rule, or of the axiom if that is null; nothing after an error.
    std::optional<double> value(const ExpressionCode& code, const LsysRule* rule,
                                std::span<const double> slots, std::span<const double> cells) {
        const std::optional<double> result = code.value(slots, cells);
        if (!result) report(code, rule, slots, cells);
        return result;
    }

    bool failed() const { return failed_; }

    /// The hint where there are too many different modules or parts.
    const char* explosion_hint() const;

  private:
    static constexpr std::uint32_t unknown = UINT32_MAX;
    static constexpr std::uint32_t none = UINT32_MAX - 1;
    static constexpr std::uint32_t error = UINT32_MAX - 2;

    /// The result of rewriting a module whose rules read the time.
    struct Timed {
        RuleKind kind;
        ModuleId module;
        Moment moment; ///< members that are not read are 0
        std::uint32_t found;
    };

    void fill_draws(const LsysRule& rule, RuleDraw draw, std::span<double> numbers);
    std::uint32_t find(RuleKind kind, ModuleId module, const Moment& moment);
    std::uint32_t find_timed(RuleKind kind, ModuleId module, Moment moment, TimeMask reads);
    std::uint32_t compute(RuleKind kind, ModuleId module, const Moment& moment);
    std::vector<double> parameters(ModuleId module) const;
    bool sums_to_one(double sum, const LsysRule& first);
    bool leaves_some(double sum, const LsysRule& first);
    std::span<const double> known_cells(RuleKind kind, double step) const;
    LsysMachine::State state_of(const LsysRule& rule, const Moment& moment, std::span<double> slots);
    void report(const ExpressionCode& code, const LsysRule* rule, std::span<const double> slots,
                std::span<const double> cells);
    std::optional<std::span<const double>> slots_of(const LsysRule& rule, std::span<const double> values,
                                                    const Moment& moment);
    bool append(const std::vector<LsysTemplate>& templates, const LsysRule* rule,
                std::span<const double> slots, std::span<const double> cells, ModuleString& string);

    const LsysGrammar& grammar_;
    Diagnostics& diagnostics_;
    std::uint64_t seed_;
    WorkMeter* meter_;
    LsysMachine machine_;
    LsysVariables variables_;
    LsysChance* chance_ = nullptr;
    bool has_ages_;
    bool pooled_ = true;
    std::uint32_t birth_ = ModuleTable::no_birth;
    ModuleTable modules_;
    std::array<std::vector<std::uint32_t>, rule_kind_count> known_; ///< by module, into alternatives_
    std::deque<std::vector<Alternative>> alternatives_;             ///< stay where they are
    std::vector<Timed> timed_;
    IdTable timed_ids_;
    std::vector<std::vector<double>> draws_; ///< of the rules, set by set
    std::vector<double> arguments_;
    std::vector<double> slots_;
    ModuleString drawn_;
    bool noted_rest_ = false;
    bool failed_ = false;
};

template<typename Entrant, typename Enter>
bool LsysRewriter::compete(RuleKind kind, SymbolId symbol, std::size_t arity, std::vector<Entrant>& entrants,
                           const Enter& enter) {
    entrants.clear();
    for (const std::uint32_t id : grammar_.candidates(kind, symbol)) {
        const LsysRule& rule = grammar_.rules[id];
        if (rule.predecessor.arity != arity || (!entrants.empty() && !rule.probability)) continue;
        Entrant entrant;
        entrant.rule = &rule;
        const Fit fit = enter(entrant);
        if (fit == Fit::error) return false;
        if (fit == Fit::no) continue;
        entrants.push_back(std::move(entrant));
        if (!rule.probability) return true;
    }
    if (entrants.empty()) return true;
    double sum = 0;
    for (const Entrant& entrant : entrants)
        sum += entrant.probability;
    if (leaves_some(sum, *entrants.front().rule)) {
        Entrant stays;
        stays.rule = &grammar_.rules[entrants.front().rule->stays];
        if (enter(stays) != Fit::yes) return false;
        stays.probability = 1 - sum;
        entrants.push_back(std::move(stays));
        share_draws(entrants, 1.0);
        return true;
    }
    if (!sums_to_one(sum, *entrants.front().rule)) return false;
    share_draws(entrants, sum);
    return true;
}

} // namespace graftal
