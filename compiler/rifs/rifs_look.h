#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/support/source.h"
#include "compiler/syntax/expression.h"

namespace graftal {

struct RifsName {
    std::string_view text;
    Span span;
};

/// `tint r, g, b, a` and `material NAME`, as a map, a row of codes, a condensation or a terminal may have.
struct RifsLook {
    std::vector<Expression> tint; ///< four, or none
    std::optional<RifsName> material;
};

} // namespace graftal
