#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/lsys/parse/ast.h"

namespace graftal {

/// Which numbers of an L-system only spread chance: the deviation of `normal`, the bounds of `random`, a
/// factor of a chance whose mean is zero, and what the rules hand on to such places alone. They scatter all
/// parts at once, and move no part by what they mean.
class ChanceSpread {
  public:
    /// The tree outlives it.
    explicit ChanceSpread(const LsysFile& tree);

    using Visitor = std::function<void(const Expression& leaf, bool only_spreads)>;
    /// Numbers and names of the module's arguments, in their order. Requires a module of the block.
    void visit(const LsysBlock& block, const LsysModule& module, const Visitor& visitor) const;

  private:
    /// An argument of a symbol.
    using Place = std::tuple<const LsysBlock*, std::string_view, std::size_t>;
    using PlaceId = std::uint32_t;
    /// An argument in a successor, and one that it is made from, other than for spread.
    using Reading = std::pair<PlaceId, PlaceId>;

    void add_formals(const LsysBlock& block, const LsysProduction& production);
    void add_readings(const LsysBlock& block, const LsysProduction& production,
                      std::vector<Reading>& readings);

    std::map<Place, PlaceId> ids_; ///< of the arguments that rules give names
    std::vector<bool> moves_;      ///< by id: whether something reads it for more than spread
};

} // namespace graftal
