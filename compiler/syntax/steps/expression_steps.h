#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compiler/syntax/expression_code.h"

namespace graftal {

/// One operation on slots, of an expression that machines without recursion compute.
struct ExpressionStep {
    /// Binary operators and functions have numbers of their own, in the order of BinaryOperator,
    /// expression_functions() and chance_functions().
    enum Operation : std::uint32_t { copy = 14, negate, invert, draw, table, functions = 20, chances = 60 };
    static_assert(copy == static_cast<std::uint32_t>(BinaryOperator::logical_or) + 1);

    std::uint32_t operation = 0;
    std::uint32_t result = 0; ///< slot
    bool whole = false;       ///< the expression has no value where this is not a number
    std::array<std::uint32_t, max_function_arity>
        operands{};           ///< slots, or ExpressionSteps::is_number + place
    std::uint32_t pieces = 0; ///< of a table, whose first number is an operand
};

/// Steps of many expressions. Both sides of operators and all arguments are computed; what is not asked for
/// may be no number.
struct ExpressionSteps {
    static constexpr std::uint32_t is_number = 1u << 15;

    std::vector<ExpressionStep> steps;
    std::vector<float> numbers;
    std::uint32_t slots = 0; ///< that they need

    /// Appends the steps of a code. Its slots lie behind the first `before`; those from `free` on are for its
    /// memory. False where it reads cells, or has more slots or numbers than operands tell apart.
    bool add(const ExpressionCode& code, std::uint32_t before, std::uint32_t free, std::uint32_t result);

    /// Likewise, a uniform number of [0, 1).
    void add_draw(std::uint32_t result);
};

} // namespace graftal
