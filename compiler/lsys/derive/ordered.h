#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/lsys/derive/context.h"
#include "compiler/lsys/derive/decompose.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// Rewrites words strictly from left to right, for grammars whose productions change variables or ask chance
/// in an order that counts (LsysGrammar::in_order). The first block of a production is carried out whenever
/// the production is tried, as in cpfg. A successor is decomposed as soon as it is made. Nothing is kept of
/// what became of equal modules. Chance depends on the seed, the step and how often it was asked in that
/// step.
class LsysOrderedRewriter {
  public:
    /// All must outlive this. `matcher` looks at the words that rewrite() gets.
    LsysOrderedRewriter(LsysRewriter& rewriter, ContextMatcher& matcher, Diagnostics& diagnostics,
                        std::uint64_t max_modules)
        : rewriter_(rewriter), diagnostics_(diagnostics), max_modules_(max_modules), matcher_(matcher),
          decomposes_(rewriter.grammar().has_rules(RuleKind::decompose)) {}

    /// Both carry out the grammar's blocks of the step; step 0 is for the axiom. `random`: of the step. False
    /// after an error.
    bool begin_step(unsigned step, const CounterRandom& random);
    bool end_step(bool is_last);
    /// To be called when all steps are done.
    void end() { rewriter_.derive_in_order(nullptr); }

    /// Adds what the word becomes, decomposed, to the next word; false after an error.
    bool rewrite(const ModuleString& word, ModuleString& next);
    /// Adds a string to the next word, decomposed; false after an error.
    bool decompose(const ModuleString& string, ModuleString& next);

  private:
    /// A production that fits.
    struct Candidate : Competitor {
        std::size_t slots = 0; ///< where its slots begin
    };
    struct Pending {
        ModuleId module;
        std::uint32_t depth;
    };

    std::optional<const LsysRule*> choose_rule(RuleKind kind, ModuleId module,
                                               std::optional<std::uint32_t> position, Moment& moment);
    Fit enter(Candidate& candidate, const Moment& moment);

    LsysRewriter& rewriter_;
    Diagnostics& diagnostics_;
    std::uint64_t max_modules_;
    ContextMatcher& matcher_;
    bool decomposes_;

    unsigned step_ = 0;
    std::optional<LsysChance> chance_; ///< of the step
    ModuleString bound_;               ///< modules whose parameters a production names
    ModuleString successor_;           ///< of a production, before it is decomposed
    ModuleString parts_;
    std::vector<Candidate> candidates_;
    std::vector<double> slots_; ///< of the candidates, or of the one that is chosen
    std::vector<Pending> pending_;
};

} // namespace graftal
