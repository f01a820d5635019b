#pragma once

#include <optional>
#include <vector>

#include "compiler/support/flat_area.h"
#include "compiler/syntax/expression.h"

namespace graftal {

/// A rectangle `x0, z0, x1, z1` of any two opposite corners, or a disc `r` or `r, x, z`, by how many numbers
/// there are: 4, 1 or 3. Errors: areas that are empty, or too large for doubles.
std::optional<FlatArea> lower_area(const std::vector<Expression>& numbers, Span span,
                                   const Environment& environment, Diagnostics& diagnostics);

} // namespace graftal
