#pragma once

#include <optional>
#include <set>
#include <string>

#include "compiler/import/cfdg/evaluate/chance.h"
#include "compiler/import/cfdg/evaluate/evaluator.h"
#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/importer.h"

namespace graftal::cfdg {

struct Interval {
    double least = 0, most = 0;
};

/// The numbers of expressions before parameters have values, without errors. `space` is the name space of the
/// rule that holds the expression.
class Expressions {
  public:
    /// All must outlive this.
    Expressions(const ForeignFile& file, const Grammar& grammar, const Chance& chance);

    /// Nothing if the number depends on names of rules or chance.
    std::optional<double> number(const Expr& expression, const std::string& space);
    /// The turns of a loop; nothing where its bounds have no known numbers.
    std::optional<double> turns(const Element& loop, const std::string& space);
    /// The range of numbers that the expression may give.
    std::optional<Interval> range(const Expr& expression, const std::string& space);
    /// The logarithm of the largest factor of size; infinite if it cannot be known.
    double growth(const Modification& modification, const std::string& space);

  private:
    /// Whether an expression or a modification depends on names of rules or chance.
    template<typename Part> bool is_open(const Part& part, const std::string& space) const {
        return chance_.decides(part, space) || any_part(part, [&](const Expr& expression) {
                   return expression.kind == Expr::Kind::name && own_.contains(expression.text);
               });
    }

    Diagnostics silent_;
    ForeignFile file_;
    Evaluator evaluator_;
    const Chance& chance_;
    std::set<std::string> own_; ///< names to which rules give meanings
};

} // namespace graftal::cfdg
