#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "compiler/syntax/expression.h"

namespace graftal {

/// Expressions by the names that stand for them.
using ExpressionNames = std::map<std::string, Expression, std::less<>>;
/// Tables by the names that calls have for them.
using ExpressionTables = std::map<std::string, std::shared_ptr<const std::vector<double>>, std::less<>>;

/// Puts the expressions in place of their names, once: names in them stay.
void write_out(Expression& expression, const ExpressionNames& values);

/// Connects calls with the tables that they name.
void connect_tables(Expression& expression, const ExpressionTables& tables);

/// Whether the expression has random numbers.
bool calls_chance(const Expression& expression);

struct ExpressionExtent {
    std::size_t words = 0; ///< numbers, names, calls and operators
    std::size_t depth = 0;
};
/// The extent of an expression with these expressions in place of their names.
ExpressionExtent extent_of(const Expression& expression, const ExpressionNames& values);

} // namespace graftal
