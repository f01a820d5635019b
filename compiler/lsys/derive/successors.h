#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/lsys/derive/context.h"
#include "compiler/lsys/derive/decompose.h"
#include "compiler/lsys/derive/module_keys.h"
#include "compiler/lsys/derive/module_runs.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// The runs that the modules of a derivation become in a step. Each distinct module is rewritten once, and
/// once for each combination of modules that the contexts of a production match around it.
class LsysSuccessors {
  public:
    /// A RunId; or one with its highest bit set for a module that has none of its own, since contexts or
    /// chance decide; or `unknown`.
    using Entry = std::uint32_t;
    static constexpr Entry unknown = UINT32_MAX;
    static bool is_run(Entry entry) { return entry < ModuleRuns::most_modules; }

    /// All must outlive this.
    LsysSuccessors(LsysRewriter& rewriter, LsysDecomposer& decomposer, Diagnostics& diagnostics);

    /// Whether all entries are runs: no production sees more than one module, or has a probability or random
    /// numbers.
    bool is_plain() const { return !sees_word_ && !is_stochastic_; }
    bool sees_word() const { return sees_word_; }
    bool is_stochastic() const { return is_stochastic_; }

    /// Nothing but `unknown` after an error.
    Entry entry(ModuleId module) {
        const Entry entry = module < entries_.size() ? entries_[module] : unknown;
        return entry != unknown ? entry : compute(module);
    }

    /// The run of a module whose entry is known to be one.
    RunId run(ModuleId module) const { return entries_[module]; }
    /// The run that takes the place of some modules of a word.
    struct Replacement {
        RunId run = 0;
        std::uint32_t modules = 1;
    };
    /// The run of a module whose entry is none, and how many of the modules from it on it replaces. `draw` is
    /// uniform over all 64 bits; `matcher` looks at the word, which has the module at this position. Nothing
    /// after an error.
    std::optional<Replacement> choose(ModuleId module, Entry entry, std::uint64_t draw,
                                      ContextMatcher& matcher, std::uint32_t position);

    const ModuleRuns& runs() const { return runs_; }

    /// To be called before each step, with its number: forgets what holds for one step only, or takes much
    /// memory; all runs and entries become invalid then.
    void begin_step(std::uint32_t step);

  private:
    /// The result of trying a rule.
    struct Outcome : Competitor {
        Fit fit = Fit::error;    ///< in outcomes_; of others not known
        RunId run = 0;           ///< of a rule without random numbers
        std::uint32_t bound = 0; ///< of one with: its modules, in bounds_
        std::uint32_t bound_count = 0;
    };
    /// The reach of the contexts of a symbol's productions.
    enum class Sight : std::uint8_t {
        none, ///< at the module alone
        near, ///< and at most at one module towards the root and one away from it
        far,
    };
    struct Contexts {
        Sight sight = Sight::none;
        bool has_left = false;
        bool has_right = false;
    };

    static constexpr Entry mark = 1u << 31;

    const Contexts& contexts(ModuleId module) const { return contexts_[rewriter_.modules().symbol(module)]; }
    void look_at(const LsysRule& rule);
    Entry compute(ModuleId module);
    Entry compute_entry(ModuleId module);
    Entry entry_nearby(ModuleId module, Entry entry, ContextMatcher& matcher, std::uint32_t position);
    Entry entry_in_context(ModuleId module, Entry entry, ContextMatcher& matcher, std::uint32_t position,
                           std::vector<Outcome>& choices);
    Entry entry_of_competing(std::vector<Outcome>& choices) const;
    template<typename Enter> bool compete(ModuleId module, const Enter& enter);
    std::optional<RunId> run_of(const Winner<Outcome>& winner);
    Moment moment(ModuleId module) const;
    Fit enter_known(Outcome& outcome, std::span<const ModuleId> bound);
    Fit enter(Outcome& outcome, std::span<const ModuleId> bound);
    std::uint32_t id_of(const LsysRule& rule) const {
        return static_cast<std::uint32_t>(&rule - rewriter_.grammar().rules.data());
    }
    void values_of(std::span<const ModuleId> modules);
    std::optional<RunId> add_successor(const ModuleString& successor, const LsysRule& rule);
    std::optional<RunId> add_run(std::span<const ModuleId> run, Span place);

    LsysRewriter& rewriter_;
    LsysDecomposer& decomposer_;
    Diagnostics& diagnostics_;
    bool sees_word_ = false;
    bool is_stochastic_ = false;
    bool is_timed_ = false; ///< rewriting depends on the step
    std::uint32_t step_ = 0;
    std::vector<Contexts> contexts_; ///< of the symbols

    ModuleRuns runs_;
    std::vector<Entry> entries_;   ///< of the modules
    std::vector<Outcome> choices_; ///< competitors, one competition after the other
    ModuleString bounds_;

    ModuleKeys<Entry> nearby_;     ///< of modules between others, by their symbols
    ModuleKeys<Outcome> outcomes_; ///< of rules
    ModuleKeys<RunId> drawn_;      ///< by rule and set of draws

    std::vector<Outcome> competing_;
    std::vector<Outcome> choices_here_; ///< at one position of the word
    ModuleString bound_;
    std::vector<double> values_;
    ModuleString decomposed_;
};

} // namespace graftal
