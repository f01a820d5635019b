#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace graftal {

/// The most arguments that a function takes.
inline constexpr std::size_t max_function_arity = 4;

/// A function that expressions may call.
struct ExpressionFunction {
    const char* name;
    std::size_t arity;
    double (*apply)(std::span<const double> arguments);
    bool chooses =
        false; ///< the second argument, or the third where the first is 0; the other is not evaluated
};

std::span<const ExpressionFunction> expression_functions();
/// Functions of random numbers: see chance_function().
std::span<const ExpressionFunction> chance_functions();
/// The function of this name, or null.
const ExpressionFunction* expression_function(std::string_view name);

/// The value of a table at x; beyond [0, 1] that of its end.
double table_value(std::span<const double> table, double x);

/// `normal` or `random`: a function of a uniform number of [0, 1) and of its two written arguments; null for
/// other names.
///   normal(mean, deviation): the quantile of a normal distribution, cut off at three deviations on either
///     side. No number for a negative deviation.
///   random(a, b): uniform.
const ExpressionFunction* chance_function(std::string_view name);
/// Arguments that a call of one of these has in the text.
inline constexpr std::size_t chance_arguments = 2;

enum class BinaryOperator : std::uint8_t {
    add,
    subtract,
    multiply,
    divide,
    remainder,
    power,
    equal,
    unequal,
    less,
    less_equal,
    greater,
    greater_equal,
    logical_and,
    logical_or,
};

/// Requires an operator that the parser knows.
BinaryOperator binary_operator(std::string_view text);
/// Neither for division by zero nor for the logical operators, which may not need their right side.
double apply_binary(BinaryOperator op, double a, double b);

} // namespace graftal
