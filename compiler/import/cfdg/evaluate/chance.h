#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>

#include "compiler/import/cfdg/parse/ast.h"

namespace graftal::cfdg {

using ExprTest = std::function<bool(const Expr&)>;

/// Whether a test holds for an expression or any part of it.
bool any_part(const Expr& expression, const ExprTest& test);
bool any_part(const Modification& modification, const ExprTest& test);
bool any_part(const Elements& elements, const ExprTest& test);

/// The expressions of a grammar that draw random numbers.
class Chance {
  public:
    /// The grammar must outlive this.
    explicit Chance(const Grammar& grammar);

    /// Whether lines of a rule in a name space draw, apart from the shapes that they call.
    bool decides(const Elements& elements, const std::string& space) const;
    bool decides(const Modification& modification, const std::string& space) const;
    bool decides(const Expr& expression, const std::string& space) const;

  private:
    ExprTest draws(const std::string& space) const;
    const Definition* function_named(const Expr& expression, const std::string& space) const;

    std::map<std::string, const Definition*> functions_;
    std::set<const Definition*> random_functions_;
};

} // namespace graftal::cfdg
