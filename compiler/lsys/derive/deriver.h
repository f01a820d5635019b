#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "compiler/lsys/derive/context.h"
#include "compiler/lsys/derive/decompose.h"
#include "compiler/lsys/derive/ordered.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/lsys/derive/successors.h"
#include "compiler/lsys/derive/word.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/diagnostics.h"

// The derivation of words, module by module. Semantics: Prusinkiewicz and Lindenmayer, The Algorithmic Beauty
// of Plants, chapter 1.

namespace graftal {

/// Words are never longer: their positions are numbered with 32 bits.
inline constexpr std::uint64_t max_word_modules = 4'000'000'000;

/// Whether `kept` are too many of `all` for sharing to pay: an instance of a shared object takes about as
/// much as three parts of a run, and time to find.
inline bool little_repeats(std::uint64_t kept, std::uint64_t all) {
    return kept > all / 8;
}

/// Derives the words of a grammar. In each step all modules are replaced at once, from left to right, by the
/// first production that fits, contexts before others, or by chance; a module that none fits stays. A
/// production that rewrites several modules passes over them. The axiom and the result
/// of each step are decomposed, and lose what stands behind a `%` in its branch. Where the order of the
/// modules counts (LsysGrammar::in_order), they are replaced one after the other.
class LsysDeriver {
  public:
    /// Both must outlive this. Requires max_modules <= max_word_modules.
    LsysDeriver(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t seed,
                std::uint64_t max_modules);

    /// The word after this many steps; its modules are in the rewriter's table. What a module becomes by
    /// chance depends on the seed, the step and the module's position alone, unless order counts. Nothing
    /// after an error, which is reported once; a step whose word would have more than max_modules is an
    /// error, found before the word takes memory. O(modules of all words), and O(modules * patterns) for
    /// contexts.
    std::optional<ModuleString> derive(unsigned steps);

    /// Sets the stage that gets the words between the steps.
    void after_each_step(LsysStage stage) { stage_ = std::move(stage); }

    /// From now on derive() gives up, without an error, where looking modules up does not pay: too few in
    /// all words are equal, and LsysStream does without. `fewest`: modules that it takes to tell.
    void give_up_where_little_repeats(std::uint64_t fewest) { gives_up_from_ = fewest; }
    bool gave_up() const { return gave_up_; }

  private:
    bool derive_to(unsigned steps);
    bool begin();
    bool set_step(unsigned step);
    bool step();
    bool rewrite();
    bool rewrite_in_order();
    std::optional<std::uint64_t> count();
    std::optional<std::uint64_t> choose_runs();
    void gather(std::uint64_t length);
    bool decompose();
    bool finish_step();
    bool is_short_enough(std::uint64_t length);

    LsysRewriter& rewriter_;
    Diagnostics& diagnostics_;
    CounterRandom random_;
    std::uint64_t max_modules_;
    LsysDecomposer decomposer_;
    LsysSuccessors successors_;
    ContextMatcher matcher_;
    std::optional<LsysOrderedRewriter> ordered_; ///< where order counts
    LsysStage stage_;
    bool has_cuts_ = false;
    bool is_timed_ = false; ///< a word may go on after a step that left it as it was
    bool failed_ = false;
    std::uint64_t gives_up_from_ = UINT64_MAX;
    bool gave_up_ = false;

    unsigned steps_ = 0; ///< of the derivation
    unsigned step_ = 0;  ///< 0: the axiom
    ModuleString word_;
    ModuleString next_;
    std::vector<RunId> chosen_; ///< for word_, from left to right
    bool changed_ = false;
};

} // namespace graftal
