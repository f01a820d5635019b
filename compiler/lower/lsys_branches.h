#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/lower/lsys_grammar.h"
#include "compiler/lower/module_table.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// A derived word with its branches taken out, innermost first: where one stood, with its brackets, stands a
/// number for it, and equal branches have one number. So all that is done for a branch can be done once; of
/// regular plants a few hundred branches make up a word of millions of modules.
class LsysBranches {
  public:
    /// Requires balanced brackets. O(word).
    LsysBranches(const LsysGrammar& grammar, const ModuleTable& modules, std::span<const ModuleId> word);

    /// The word outside of all branches, with their numbers in it.
    std::span<const ModuleId> trunk() const { return trunk_; }
    /// Whether it is the number of a branch, not a module.
    static bool is_branch(ModuleId module) { return (module & mark) != 0; }
    /// What stands between the brackets of a branch, with the numbers of the branches in it.
    std::span<const ModuleId> branch(ModuleId number) const {
        const Range& range = ranges_[number & ~mark];
        return std::span(store_).subspan(range.first, range.count);
    }

  private:
    static constexpr ModuleId mark = 1u << 31; ///< above the ids of all modules

    struct Range {
        std::size_t first = 0; ///< of store_
        std::size_t count = 0;
    };

    ModuleId number_of(std::span<const ModuleId> branch);

    ModuleString trunk_;
    ModuleString store_;
    std::vector<Range> ranges_; ///< of the branches
    IdTable ids_;
};

} // namespace graftal
