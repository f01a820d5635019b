#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/lsys/derive/context.h"
#include "compiler/lsys/derive/decompose.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/lsys/derive/word.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// Derives words strictly from left to right, for grammars whose productions change variables or ask chance
/// in an order that counts (LsysGrammar::in_order). The first block of a production is carried out whenever
/// the production is tried, as in cpfg. A successor is decomposed as soon as it is made. Nothing is kept of
/// what became of equal modules. Chance depends on the seed, the step and how often it was asked in that
/// step.
class LsysOrderedDeriver {
  public:
    /// Both must outlive this. Requires max_modules <= max_word_modules.
    LsysOrderedDeriver(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t seed,
                       std::uint64_t max_modules);

    /// Does what LsysDeriver::derive() does.
    std::optional<ModuleString> derive(unsigned steps);
    void after_each_step(LsysStage stage) { stage_ = std::move(stage); }

  private:
    /// A production that fits, with its slots.
    struct Candidate {
        const LsysRule* rule = nullptr;
        double probability = 1;
        std::vector<double> slots;
    };
    struct Pending {
        ModuleId module;
        std::uint32_t depth;
    };

    bool derive_to(unsigned steps);
    bool begin();
    bool step();
    bool rewrite(std::uint32_t position, std::uint32_t& consumed);
    bool decompose(const ModuleString& string);
    std::optional<const LsysRule*> choose(RuleKind kind, ModuleId module,
                                          std::optional<std::uint32_t> position, Moment& moment);
    Fit attempt(const LsysRule& rule, const Moment& moment);
    Candidate* chosen_of(const LsysRule& first);

    LsysRewriter& rewriter_;
    Diagnostics& diagnostics_;
    CounterRandom random_;
    std::uint64_t max_modules_;
    ContextMatcher matcher_;
    LsysStage stage_;
    bool has_cuts_;
    bool decomposes_;

    unsigned step_ = 0;
    std::optional<LsysChance> chance_; ///< of the step
    ModuleString word_, next_;
    ModuleString bound_;     ///< modules whose parameters a production names
    ModuleString successor_; ///< of a production, before it is decomposed
    ModuleString parts_;
    std::vector<Candidate> candidates_; ///< the first candidate_count_
    std::size_t candidate_count_ = 0;
    std::vector<double> slots_; ///< of the chosen production
    std::vector<Pending> pending_;
};

} // namespace graftal
