#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/syntax/area.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// `a..b`, or `a` alone.
struct InstRange {
    Expression from;
    std::optional<Expression> to;
    Span span;
};

/// The order in which places are chosen.
enum class ScatterOrder : std::uint8_t { poisson, uniform, jitter, spiral };

/// The lines of `scatter:`, unevaluated.
struct InstScatter {
    std::optional<Expression> count;
    std::optional<AreaText> over;
    std::vector<AreaText> except; ///< places inside one of these are left out
    std::optional<ScatterOrder> by;
    std::optional<Expression> apart; ///< the least distance
    std::optional<Expression> seed;
    std::optional<InstRange> turn; ///< degrees about `turn_axis`
    int turn_axis = 1;
    std::optional<InstRange> lean; ///< degrees out of the vertical
    std::optional<InstRange> size;
    std::vector<Expression> weights; ///< by master; none: all alike
    std::size_t ordinal = 0;         ///< among those of the file, the seed where none is given
    Span weights_span;
    bool complete = true; ///< false if a line was in error
};

/// The words of its lines: "count", "over", ...
const std::vector<std::string_view>& scatter_keywords();

/// True if the next token begins a line of a scatter: one of its words, or a number, which is the count.
bool at_scatter_line(const TokenStream& stream);

/// Requires at_scatter_line(). Takes one line; false after an error.
bool parse_scatter_line(TokenStream& stream, InstScatter& scatter);

} // namespace graftal
