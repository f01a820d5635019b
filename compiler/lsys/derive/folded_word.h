#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/compile/module_table.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// A derived word in pieces, each kept once however often it occurs: the branches, and long strings cut into
/// runs, runs of runs and so on. The modules near by choose the cuts, so that equal strings are cut alike.
/// Work on a piece is so done once: of regular models some hundred pieces make up a word of millions of
/// modules. The number of a piece stands in strings like a module.
class FoldedWord {
  public:
    /// Requires balanced brackets. A word whose polygons cross branches is one piece. O(word), in its place.
    FoldedWord(const LsysGrammar& grammar, const ModuleTable& modules, ModuleString word);

    /// Modules and pieces that are kept.
    std::size_t size() const { return trunk_.size() + store_.size(); }
    /// The modules and pieces outside of all pieces.
    std::span<const ModuleId> trunk() const { return trunk_; }
    /// Whether it is the number of a piece, not a module.
    static bool is_piece(ModuleId module) { return module >= run_mark; }
    /// Whether the piece is a branch; else it is a run.
    static bool is_branch(ModuleId module) { return module >= branch_mark; }
    /// The modules and pieces in a piece, without its brackets.
    std::span<const ModuleId> piece(ModuleId number) const {
        const Range& range = ranges_[number & (run_mark - 1)];
        return std::span(store_).subspan(range.first, range.count);
    }

  private:
    static constexpr ModuleId run_mark = 1u << 30; ///< above the ids of all modules
    static constexpr ModuleId branch_mark = 1u << 31;

    struct Range {
        std::size_t first = 0; ///< of store_
        std::size_t count = 0;
        ModuleId mark = 0;
    };

    void fold(const std::vector<TurtleCommand>& commands, const ModuleTable& modules);
    std::size_t cut_into_runs(std::size_t first, std::size_t last);
    std::size_t end_of_run(std::size_t first, std::size_t last) const;
    ModuleId number_of(std::size_t first, std::size_t last, ModuleId mark);

    std::vector<bool> opens_polygon_, closes_polygon_; ///< of the modules; empty if none does
    ModuleString trunk_;                               ///< while it is folded, followed by what is not
    ModuleString store_;
    std::vector<Range> ranges_; ///< of the pieces
    IdTable ids_;
};

} // namespace graftal
