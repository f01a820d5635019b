#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/support/source.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/names.h"

// The tree of `follow`, the control digraph of a `rifs` block or an orbit.

namespace graftal {

/// More edges and matrix entries than this in one `follow` are refused while parsing.
inline constexpr std::size_t max_rifs_edges = 4'000'000;

/// w_to may be applied after w_from.
struct RifsEdge {
    Name from;
    Name to;
};

/// An entry of a control matrix; literal zeros are not kept. A matrix may have millions: plain numbers stand
/// here, others in RifsFollow::expressions.
struct RifsCell {
    static constexpr std::uint32_t literal = UINT32_MAX;

    std::uint32_t row = 0;
    std::uint32_t column = 0;
    double number = 0;
    std::uint32_t expression = literal;
    Span span;
};

struct RifsMatrixRow {
    std::uint32_t columns = 0;
    Span span;
};

struct RifsFollow {
    /// all_except: all edges but `edges`; edges: those only.
    enum class Kind : std::uint8_t { all, all_except_self, all_except, edges, matrix };

    Kind kind = Kind::all;
    std::vector<RifsEdge> edges;
    std::vector<RifsMatrixRow> rows;
    std::vector<RifsCell> cells; ///< row by row
    std::vector<Expression> expressions;
    Span span;
};

} // namespace graftal
