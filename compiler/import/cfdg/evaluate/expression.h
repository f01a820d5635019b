#pragma once

#include <map>
#include <optional>
#include <string>

#include "compiler/import/cfdg/parse/ast.h"

namespace graftal::cfdg {

/// Names with known numbers.
using Numbers = std::map<std::string, double>;

struct Interval {
    double least = 0, most = 0;
};

/// The numbers that are known without values of parameters.
class Expressions {
  public:
    /// The grammar must outlive this.
    explicit Expressions(const Grammar& grammar);

    /// The number, without an error: nothing if it depends on parameters or chance.
    std::optional<double> number(const Expr& expression) const { return evaluate(expression, {}, 0); }
    /// The range of numbers that the expression may give.
    std::optional<Interval> range(const Expr& expression) const;
    const Definition* definition(const std::string& name) const;
    /// The adjustment of the file that `trans NAME` names; null if there is none.
    const Definition* modification(const Adjustment& adjustment) const;

  private:
    std::optional<double> evaluate(const Expr& expression, const Numbers& known, int depth) const;

    std::map<std::string, double> values_; ///< of the constants
    std::map<std::string, const Definition*> definitions_;
    mutable std::size_t work_ = 0; ///< numbers evaluated: functions that call each other can be endless
};

} // namespace graftal::cfdg
