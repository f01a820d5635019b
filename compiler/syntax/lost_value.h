#pragma once

#include <limits>

namespace graftal {

/// Stands in an Environment for a value that an error lost. evaluate() and ExpressionCode::compile() give
/// nothing for an expression that reads it, without a second message.
inline constexpr double lost_value = std::numeric_limits<double>::quiet_NaN();

} // namespace graftal
