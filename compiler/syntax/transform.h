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
    enum class Kind : std::uint8_t { scale, rotate, translate, shear, matrix, projection };

    Kind kind = Kind::scale;
    /// scale: 1 to 3 numbers; translate: 2 or 3; rotate: degrees, or axis vector and degrees where `axes` is
    /// empty; shear: the factor; matrix and projection: 12, row by row.
    std::vector<Expression> numbers;
    std::string_view axes; ///< rotate: `x`, `y` or `z`; shear: e.g. `xy`
    Span span;
};

/// "scale", "rotate", ...: in the order of TransformLine::Kind.
inline constexpr std::array<std::string_view, 6> transform_keywords = {"scale", "rotate", "translate",
                                                                       "shear", "matrix", "projection"};

/// True if the next token is the keyword of a transform line.
bool at_transform(const TokenStream& stream);

/// Parses a line at its keyword (the colon is optional), or reports why not and gives nothing.
std::optional<TransformLine> parse_transform(TokenStream& stream);

} // namespace graftal
