#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/expression_cells.h"

namespace graftal {

/// An arithmetic expression over named values: + - * / % ^ (right associative, binds tighter than a sign on
/// its left), comparisons and ! && || (giving 1 or 0), functions, and the constant pi. Trigonometric
/// functions take and give degrees, as turtles and POV-Ray's users do: sin cos tan asin acos atan atan2;
/// sqrt exp log floor ceil abs min max mod sign pow lerp smooth logistic, and choose, which evaluates the
/// argument that it gives only. Where a model has arrays, `a[i]` and `a[i][j]` are their elements.
struct Expression {
    enum class Kind : std::uint8_t { number, name, call, unary, binary, element };

    Kind kind = Kind::number;
    double number = 0;
    std::string text;                 ///< the name, function, operator or array
    std::vector<Expression> operands; ///< of a call, unary or binary; the indices of an element
    /// The table of a call: values at even distances of [0, 1], straight between them; at least two.
    std::shared_ptr<const std::vector<double>> table;
    Span span;
};

/// The values that names have; `pi` and the functions need no entry.
using Environment = std::map<std::string, double, std::less<>>;

/// Uniform numbers of [0, 1) for the calls of `normal` and `random` in an expression.
using ChanceDraws = std::map<const Expression*, double>;

/// The value, or nothing after an error in `diagnostics`: unknown names (with a suggestion), wrong numbers
/// of arguments, division by zero, or results that are not finite. Indices outside of their array, and calls
/// of `normal` and `random` without a draw, are errors too. Names of the environment hide those of `cells`.
std::optional<double> evaluate(const Expression& expression, const Environment& environment,
                               Diagnostics& diagnostics, const ChanceDraws& draws = {},
                               const ExpressionCells& cells = {});

} // namespace graftal
