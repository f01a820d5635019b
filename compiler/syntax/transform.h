#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/syntax/expression.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// One line of a transform list, shared by `.inst` and `.rifs`; lowered by lower/lower_transform.h.
struct TransformLine {
    enum class Kind : std::uint8_t { scale, rotate, translate, shear, matrix, projection, points };

    Kind kind = Kind::scale;
    /// scale: 1 to 3 numbers; translate: 2 or 3; rotate: degrees, or axis vector and degrees where `axes` is
    /// empty; shear: the factor; matrix and projection: 12, row by row; points: two or three points of the
    /// plane or four of space, then the image of each.
    std::vector<Expression> numbers;
    std::string_view axes; ///< rotate: `x`, `y` or `z`; shear: e.g. `xy`
    Span span;
};

/// "scale", "rotate", ...: in the order of TransformLine::Kind.
inline constexpr std::array<std::string_view, 7> transform_keywords = {
    "scale", "rotate", "translate", "shear", "matrix", "projection", "points"};

/// Parses `<0, 0>, <1, 0>` to the end of `numbers`: points of two or three coordinates, all of as many as
/// `dimensions`, which is set by the first if it is 0. Returns how many there are, 0 after an error.
std::size_t parse_points(TokenStream& stream, std::vector<Expression>& numbers, std::size_t& dimensions,
                         const char* hint);

/// Coordinates of each point of a `points` line with so many numbers: 2 or 3.
std::size_t point_dimensions(std::size_t numbers);

/// True if the next token is the keyword of a transform line.
bool at_transform(const TokenStream& stream);

/// Parses a line at its keyword (the colon is optional), or reports why not and gives nothing.
std::optional<TransformLine> parse_transform(TokenStream& stream);

} // namespace graftal
