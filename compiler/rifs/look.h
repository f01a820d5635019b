#pragma once

#include <optional>
#include <vector>

#include "compiler/syntax/expression.h"
#include "compiler/syntax/names.h"

namespace graftal {

/// `tint r, g, b, a` and `material NAME`, as a map, a row of codes, a condensation or a terminal may have.
struct RifsLook {
    std::vector<Expression> tint; ///< four, or none
    std::optional<Name> material;
};

} // namespace graftal
