#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/syntax/expression.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// `x0, z0, x1, z1`, `disc r`, `disc r, x, z` or `ground`.
struct AreaText {
    enum class Kind : std::uint8_t { rectangle, disc, ground };

    Kind kind = Kind::rectangle;
    std::vector<Expression> numbers; ///< 4 of a rectangle, 1 or 3 of a disc
    Span span;
};

/// An area of numbers: `what` names the place in messages. `ground` is taken if `may_be_ground`.
std::optional<AreaText> parse_area(TokenStream& stream, std::string_view what, bool may_be_ground);

} // namespace graftal
