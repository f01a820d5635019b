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
};

std::span<const ExpressionFunction> expression_functions();
/// The function of this name, or null.
const ExpressionFunction* expression_function(std::string_view name);

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
