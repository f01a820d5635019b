#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/inst/parse/ast.h"

namespace graftal {

/// The most variants that the graph contains of one random object (lower/permutation.h); a power of two.
inline constexpr std::uint32_t inst_variants = 64;

/// Knows which objects of a file are random: they draw random numbers, have a weight, or contain a random
/// object. It goes by names, whatever the arguments.
class InstChance {
  public:
    /// `module` must outlive this. O(words).
    explicit InstChance(const InstModule& module);

    bool is_random(std::string_view name) const { return random_.contains(name); }
    bool has_random() const { return !random_.empty(); }
    /// Objects of this name may reach themselves, or a used model.
    bool may_recur(std::string_view name) const { return recurring_.contains(name); }
    /// The calls of `random` and `normal` in a group and its repeats, except those in the lines of a scatter.
    const std::vector<const Expression*>& calls(const InstGroup& group) const;

  private:
    std::set<std::string, std::less<>> random_;
    std::set<std::string, std::less<>> recurring_;
    std::unordered_map<const InstGroup*, std::vector<const Expression*>> calls_; ///< looked up only
};

} // namespace graftal
