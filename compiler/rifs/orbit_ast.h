#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/rifs/follow_ast.h"
#include "compiler/rifs/look.h"
#include "compiler/support/source.h"
#include "compiler/syntax/expression.h"

// `orbit NAME { ... }` in a `.rifs` file (docs/language.md): maps of the plane or of space written as
// formulas.

namespace graftal {

/// `NAME(a, b) = number`.
struct OrbitFunction {
    Name name;
    std::vector<Name> parameters;
    Expression body;
};

/// A name that stands for a number, in a block or in a map.
struct OrbitLet {
    Name name;
    Expression value;
};

struct OrbitMap {
    Name name;                                ///< of a map without one: an empty text, at the map
    std::vector<OrbitLet> lets;               ///< of x, y, z and those above
    std::optional<Expression> coordinates[3]; ///< the new x, y, z
    std::optional<Expression> probability;
    RifsLook look;
    Span span;
};

struct OrbitBlock {
    Name name;
    std::vector<OrbitLet> lets;
    std::vector<OrbitFunction> functions;
    std::vector<OrbitMap> maps;
    std::optional<OrbitMap> last;     ///< `final`: of what is shown of each point
    std::optional<RifsFollow> follow; ///< a matrix
    std::vector<Expression> start;    ///< none, two or three
    std::optional<Expression> skip, restart;
    Span span; ///< of the keyword and the name
};

} // namespace graftal
