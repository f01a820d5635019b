#include "compiler/syntax/write_out.h"

#include <algorithm>

#include "compiler/syntax/expression_functions.h"

namespace graftal {

void write_out(Expression& expression, const ExpressionNames& values) {
    if (expression.kind == Expression::Kind::name) {
        const auto value = values.find(expression.text);
        if (value != values.end()) expression = value->second;
        return;
    }
    for (Expression& operand : expression.operands)
        write_out(operand, values);
}

void connect_tables(Expression& expression, const ExpressionTables& tables) {
    if (expression.kind == Expression::Kind::call)
        if (const auto table = tables.find(expression.text); table != tables.end())
            expression.table = table->second;
    for (Expression& operand : expression.operands)
        connect_tables(operand, tables);
}

bool calls_chance(const Expression& expression) {
    if (expression.kind == Expression::Kind::call && chance_function(expression.text)) return true;
    return std::ranges::any_of(expression.operands, calls_chance);
}

ExpressionExtent extent_of(const Expression& expression, const ExpressionNames& values) {
    if (expression.kind == Expression::Kind::name)
        if (const auto value = values.find(expression.text); value != values.end())
            return extent_of(value->second, {});
    ExpressionExtent extent{1, 1};
    for (const Expression& operand : expression.operands) {
        const ExpressionExtent inner = extent_of(operand, values);
        extent.words += inner.words;
        extent.depth = std::max(extent.depth, inner.depth + 1);
    }
    return extent;
}

} // namespace graftal
