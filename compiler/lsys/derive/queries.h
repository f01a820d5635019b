#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/environment/environment.h"
#include "compiler/graph/graph.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/lsys/turtle/turtle.h"
#include "compiler/support/counter_random.h"

namespace graftal {

/// The settings of the turtle that a grammar asks for; it draws on `bodies`.
TurtleContext turtle_context(const LsysGrammar& grammar, TurtleBodies& bodies, Diagnostics& diagnostics);
/// The state of the turtle at the start, except for its width.
TurtleState turtle_start(const LsysGrammar& grammar);

/// Answers the queries of a word before the next step is derived. A turtle walks along the word, as it is
/// interpreted, and meets queries. It puts its place or direction, or what the environment says, into their
/// parameters (Prusinkiewicz, James and Mech 1994, "Synthetic topiary", section 3).
class LsysQueries {
  public:
    /// Both must outlive this. `seed`: of what chance decides.
    LsysQueries(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t seed);

    /// Replaces the queries of the word after a step; false after an error. O(modules), and what the
    /// environment takes.
    bool answer(std::uint32_t step, ModuleString& word);

  private:
    /// A query that the turtle has met.
    struct Met {
        std::size_t at = 0; ///< in the word; unheard if it stands in an interpretation
        bool heard = false;
        ModuleId module = 0;
        Vec3 place{0.0};
        std::vector<double> values;
    };
    /// A string that is drawn in place of a module, under way.
    struct Level {
        ModuleString string;
        std::size_t next = 0;
    };

    bool walk(std::uint32_t step, const ModuleString& word);
    bool meet(std::uint32_t step, ModuleId module, std::uint32_t birth, std::size_t at, bool in_word);
    bool step_over(ModuleId module, std::size_t at, bool in_word);
    bool ask_environment();

    LsysRewriter& rewriter_;
    const LsysGrammar& grammar_;
    Diagnostics& diagnostics_;
    CounterRandom random_;
    Graph scratch_;
    TurtleBodies bodies_;
    TurtleContext context_;
    std::unique_ptr<GrowthEnvironment> environment_; ///< null: none
    bool failed_ = false;
    std::vector<Met> met_;
    std::vector<Level> levels_;
    std::uint64_t chosen_ = 0; ///< interpretations that chance has chosen in this walk
    std::unique_ptr<Turtle> turtle_;
};

} // namespace graftal
