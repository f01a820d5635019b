#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/inst/inst_ast.h"

namespace graftal {

/// Random objects stand in the graph as so many variants at most (lower/permutation.h); a power of two.
inline constexpr std::uint32_t inst_variants = 64;

/// Which objects of a file chance has a part in: those that draw random numbers or are chosen by weight, and
/// those that hold one of them. By names, whatever their arguments.
class InstChance {
  public:
    /// `module` must outlive this. O(words).
    explicit InstChance(const InstModule& module);

    bool is_random(std::string_view name) const { return random_.contains(name); }
    /// Objects of this name may reach themselves, or a used model.
    bool may_recur(std::string_view name) const { return recurring_.contains(name); }
    /// The calls of `random` and `normal` in a group and its repeats, those of a scatter's own lines aside.
    const std::vector<const Expression*>& calls(const InstGroup& group) const;

  private:
    std::set<std::string, std::less<>> random_;
    std::set<std::string, std::less<>> recurring_;
    std::unordered_map<const InstGroup*, std::vector<const Expression*>> calls_; ///< looked up only
};

} // namespace graftal
