#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/syntax/expression.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// An expression has at most this many numbers, names and operators, and so at most this depth.
inline constexpr std::size_t max_expression_size = 1000;

/// Parses one expression, or reports why not and gives nothing; tokens that were taken stay taken.
std::optional<Expression> parse_expression(TokenStream& stream);

/// Parses an expression in a row of numbers without commas. A sign with white space before it and none after
/// it begins the next number, and so does a '<': `1 -2` is two numbers, `1 - 2` and `1-2` are one.
std::optional<Expression> parse_row_expression(TokenStream& stream);

/// Parses `min` to `max` expressions, as `a, b, c` or `<a, b, c>`, or as a row: `a b c`, `<a b c>`. In a row
/// signs are those of parse_row_expression(). It ends with its line once there are `min`, and at a word that
/// begins another line. `what` names the place in messages: "'scale' takes 1 to 3 numbers", `hint` says what
/// they are. A comma before a line's keyword or after the last number that fits is left alone.
std::optional<std::vector<Expression>> parse_numbers(TokenStream& stream, std::size_t min, std::size_t max,
                                                     std::string_view what, std::string_view hint = {});

/// Expressions with commas between them, up to the ')'. Requires that the '(' was just taken; false after an
/// error.
bool parse_arguments(TokenStream& stream, std::vector<Expression>& arguments);

/// Parses three numbers, as parse_numbers() reads them.
std::optional<std::vector<Expression>> parse_vector(TokenStream& stream, std::string_view what);

/// A colour: a vector that `rgb` may precede, three expressions; or `hsv(h, s, v)`, one call of that name
/// with three operands, which lower/lower_transform.h understands.
std::optional<std::vector<Expression>> parse_color(TokenStream& stream, std::string_view what);

/// A tint: colour and alpha, four numbers, or `rgb <r, g, b> a`: four expressions; or `hsv(h, s, v) a`: two.
std::optional<std::vector<Expression>> parse_tint(TokenStream& stream, std::string_view what);

} // namespace graftal
