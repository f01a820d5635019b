#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/inst/parse/ast.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// The definitions of one `.inst` file by name and pattern.
class InstIndex {
  public:
    /// Reports duplicates and names that cannot be defined. `module` must outlive the index.
    InstIndex(const InstModule& module, Diagnostics& diagnostics);

    /// The definition of `name` with these arguments; null if nothing matches. Numbers in a pattern are
    /// preferred to names, from left to right. `object_name` is inst_object_name(name, arguments).
    const InstDefinition* match(std::string_view name, const std::vector<double>& arguments,
                                std::string_view object_name) const;

    /// The definitions from which chance chooses where this one matches: all of the same pattern, each with
    /// its weight, or this one alone if it has no weight. Requires that match() gives it.
    std::vector<const InstDefinition*> alternatives(const InstDefinition& definition) const;

    /// All parameters are numbers, and no pattern with names competes: the object of a printed graph. Other
    /// objects with parameters exist as far as they are reached.
    bool always_exists(const InstDefinition& definition) const;

    /// The definitions of this name and number of parameters that name parameters, most specific first.
    const std::vector<const InstDefinition*>& patterns(std::string_view name, std::size_t arity) const;

    /// Any definition of this name; null if there is none.
    const InstDefinition* any(std::string_view name) const;
    /// Whether the name is defined with this number of parameters.
    bool defined(std::string_view name, std::size_t arity) const;

    std::vector<std::string> names() const;

  private:
    using NameAndArity = std::pair<std::string, std::size_t>;

    void add(const InstDefinition& definition, Diagnostics& diagnostics);
    void add_alternative(const InstDefinition& first, const InstDefinition& definition,
                         Diagnostics& diagnostics);

    std::unordered_map<std::string, const InstDefinition*> by_pattern_; ///< names of parameters as `_`
    std::unordered_map<const InstDefinition*, std::vector<const InstDefinition*>>
        others_; ///< of a pattern's first
    std::map<NameAndArity, std::vector<const InstDefinition*>> patterns_;
    std::map<std::string, const InstDefinition*, std::less<>> first_;
};

/// `tip(3)`, `f(1, -0.5)`; without arguments the name alone. Different arguments give different names.
std::string inst_object_name(std::string_view name, const std::vector<double>& arguments);

} // namespace graftal
