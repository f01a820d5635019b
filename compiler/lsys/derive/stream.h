#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/lsys/derive/folded_word.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/lsys/turtle/model_placer.h"
#include "compiler/lsys/turtle/turtle.h"
#include "compiler/lsys/turtle/witness.h"
#include "compiler/support/counter_random.h"

namespace graftal {

/// Derives and draws in one go, module by module, for words in which little repeats: no module is looked up,
/// no word is kept. A module is replaced down to the last step before the next one is looked at: one string
/// a step is kept. Chance for a module depends on the seed, the step and its place in the word of that step,
/// as in LsysDeriver. The word is the same, except for the rounding of its parameters (NumberTable).
class LsysStream {
  public:
    struct Options {
        unsigned steps = 0;
        double share = 0; ///< of the step after these that has passed when it is drawn
        std::uint64_t seed = 0;
        std::uint64_t max_modules = 50'000'000;
    };

    /// Whether words of the grammar can be derived so: a context sees its neighbours, a cut what stands
    /// behind it, and decompositions come between the steps.
    static bool can_derive(const LsysGrammar& grammar);
    /// Whether what is drawn can be told from the module and its place alone: not where chance draws a film.
    static bool can_draw(const LsysGrammar& grammar);

    /// All must outlive this.
    LsysStream(LsysRewriter& rewriter, const ModelPlacer& models, Diagnostics& diagnostics,
               const Options& options);

    /// Derives the word and draws it by the turtle; false after an error. Requires can_derive() and
    /// can_draw().
    bool derive(Turtle& turtle);
    /// Derives the word without drawing it; false if it has more than max_modules, interpretations included,
    /// or after another error. Requires can_derive().
    bool count();
    /// Draws a word that is derived already. Requires can_draw().
    bool draw(const FoldedWord& word, Turtle& turtle);

    /// From now on the witness, which must outlive this, hears of what is drawn.
    void tell(WordWitness& witness) { witness_ = &witness; }

    /// Number of modules of the word.
    std::uint64_t module_count() const { return modules_; }

  private:
    /// A string under way.
    struct Frame {
        const std::vector<LsysTemplate>* string = nullptr;
        const LsysRule* rule = nullptr; ///< null: the axiom
        std::uint32_t at = 0;           ///< next in the string
        std::uint32_t slots = 0;        ///< where the values of the rule's names begin
        std::uint32_t slot_count = 0;
        std::span<const double> cells; ///< the variables
        std::uint32_t word = 0;        ///< the step after which its modules stand in the word
        std::uint32_t birth = 0;
        std::uint32_t repeated = 0; ///< interpretations around it
        bool interprets = false;
    };
    /// A module whose parameters are the last of values_.
    struct Module {
        SymbolId symbol = 0;
        std::uint32_t arity = 0;
        std::uint32_t birth = 0;
        Span span;
    };
    /// A rule and the random numbers for it.
    struct Chosen {
        const LsysRule* rule = nullptr; ///< null: none fits
        RuleDraw draw;
    };

    bool run();
    bool read_module(Frame& frame, Module& module);
    bool meet(const Module& module, std::uint32_t word);
    bool emit(const Module& module, std::uint32_t repeated);
    bool draw(const FoldedWord& word, std::span<const ModuleId> string);
    bool draw_bracket(TurtleCommand command);
    bool carry_out(const Module& module);
    bool push(const Chosen& chosen, const Module& module, const Moment& moment, Frame frame);
    bool choose_rule(RuleKind kind, const Module& module, const Moment& moment, std::uint64_t draw,
                     Chosen& chosen);
    bool count_from(std::uint32_t word);
    std::uint64_t modules_in(std::uint32_t word) const;
    std::span<const double> parameters(const Module& module) const {
        return std::span(values_).last(module.arity);
    }

    LsysRewriter& rewriter_;
    const LsysGrammar& grammar_;
    const ModelPlacer& models_;
    Diagnostics& diagnostics_;
    Options options_;
    Turtle* turtle_ = nullptr; ///< draws; null: nobody draws
    WordWitness* witness_ = nullptr;
    CounterRandom random_;
    bool chooses_ = false; ///< by chance, in steps
    std::vector<Frame> frames_;
    std::vector<double> values_; ///< of all frames' names, and of the module under way
    /// Modules of the word so far, by step, without those that stay as they are from that step or an earlier
    /// one on.
    std::vector<std::uint64_t> in_word_;
    /// The modules that stay by the step from which on they do, counted where chance is; sums over ranges of
    /// steps (P. Fenwick 1994), since each counts in all later words.
    std::vector<std::uint64_t> staying_;
    std::vector<Competitor> competitors_;
    std::uint64_t modules_ = 0;
    std::uint64_t interpreted_ = 0; ///< choices made when drawing
    std::uint64_t drawn_ = 0;       ///< by count(): modules that a turtle would run
};

} // namespace graftal
