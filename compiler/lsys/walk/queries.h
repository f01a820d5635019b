#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/environment/environment.h"
#include "compiler/lsys/walk/walk.h"

namespace graftal {

/// Answers the queries of a word before the next step is derived. A turtle walks along the word, as it is
/// interpreted, and meets queries. It puts its place or direction, or what the environment says, into their
/// parameters (Prusinkiewicz, James and Mech 1994, "Synthetic topiary", section 3).
class LsysQueries : private LsysWalk::Listener {
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
    void asks(ModuleId module, std::size_t at, bool in_word, const Turtle& turtle) override;
    bool ask_environment();

    LsysRewriter& rewriter_;
    const LsysGrammar& grammar_;
    LsysWalk walk_;
    std::unique_ptr<GrowthEnvironment> environment_; ///< null: none
    bool failed_ = false;
    std::vector<Met> met_;
};

} // namespace graftal
