#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/lsys/turtle/turtle.h"
#include "compiler/support/counter_random.h"

namespace graftal {

/// The settings of the turtle that a grammar asks for; it draws on `bodies`.
TurtleContext turtle_context(const LsysGrammar& grammar, TurtleBodies& bodies, Diagnostics& diagnostics);
/// The state of the turtle at the start, except for its width.
TurtleState turtle_start(const LsysGrammar& grammar);

/// Follows a word as it is interpreted, with a turtle that draws nothing.
class LsysWalk {
  public:
    /// Hears of modules on the way.
    class Listener {
      public:
        virtual ~Listener() = default;
        /// A query, in the word at this place or in what a module there is drawn as.
        virtual void asks(ModuleId module, std::size_t at, bool in_word, const Turtle& turtle) = 0;
    };

    /// Both must outlive this. `random`: what chooses interpretations.
    LsysWalk(LsysRewriter& rewriter, Diagnostics& diagnostics, CounterRandom random);

    /// Walks along the word after a step; false after an error. O(modules that are drawn).
    bool run(std::uint32_t step, const ModuleString& word, Listener& listener);

  private:
    /// A string that is drawn in place of a module, under way.
    struct Level {
        ModuleString string;
        std::size_t next = 0;
    };

    bool meet(ModuleId module, std::uint32_t birth, bool in_word);
    bool step_over(ModuleId module, bool in_word);

    LsysRewriter& rewriter_;
    const LsysGrammar& grammar_;
    Diagnostics& diagnostics_;
    CounterRandom random_;
    Graph scratch_;
    TurtleBodies bodies_;
    TurtleContext context_;
    std::vector<Level> levels_;
    std::uint64_t chosen_ = 0; ///< interpretations that chance has chosen in this walk
    std::uint32_t step_ = 0;
    std::size_t at_ = 0;
    Listener* listener_ = nullptr;
    std::unique_ptr<Turtle> turtle_;
};

} // namespace graftal
