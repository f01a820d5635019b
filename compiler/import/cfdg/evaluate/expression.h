#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/importer.h"

namespace graftal::cfdg {

/// Names at a place, and our text for them.
using Scope = std::map<std::string, std::string>;
/// Names with known numbers.
using Numbers = std::map<std::string, double>;

struct Interval {
    double least = 0, most = 0;
};

/// Expressions of a grammar as text of ours, and as numbers.
class Expressions {
  public:
    /// Both must outlive this.
    Expressions(const ForeignFile& file, const Grammar& grammar);

    /// Our text; nothing after an error that names what has no counterpart.
    std::optional<std::string> text(const Expr& expression, const Scope& scope);
    /// The number, without an error: nothing if it depends on parameters or chance.
    std::optional<double> number(const Expr& expression, const Numbers& known = {}) const;
    /// The range of numbers that the expression may give.
    std::optional<Interval> range(const Expr& expression) const;
    /// Whether the name of a variable or an index occurs in it.
    static bool mentions(const Expr& expression, const std::string& name);

    /// The numbers of the file that become `let`s.
    const std::vector<const Definition*>& constants() const { return constants_; }
    const Definition* definition(const std::string& name) const;
    /// The adjustment of the file that `trans NAME` names; null if there is none.
    const Definition* modification(const Adjustment& adjustment) const;

  private:
    std::optional<std::string> element(const Expr& expression, const Scope& scope);
    std::optional<std::string> let(const Expr& expression, const Scope& scope);
    std::optional<std::string> name(const Expr& expression, const Scope& scope);
    std::optional<std::string> call(const Expr& expression, const Scope& scope);
    std::optional<std::string> own_function(const Expr& expression, const Definition& function,
                                            const std::vector<std::string>& arguments);
    std::optional<std::string> known_function(const Expr& expression,
                                              const std::vector<std::string>& arguments);
    std::nullopt_t fail(const Expr& expression, std::string message);
    std::optional<double> evaluate(const Expr& expression, const Numbers& known, int depth) const;

    const ForeignFile& file_;
    const Grammar& grammar_;
    std::vector<const Definition*> constants_;
    std::map<std::string, double> values_; ///< of the constants
    std::map<std::string, const Definition*> definitions_;
    int depth_ = 0; ///< of functions that call each other
    std::size_t written_ = 0;
    mutable std::size_t work_ = 0; ///< numbers evaluated: functions that call each other can be endless
};

/// Whether our text draws random numbers.
bool is_random(const std::string& text);

} // namespace graftal::cfdg
