#pragma once

#include <string>

namespace graftal::cfdg {

inline constexpr double endless = 1e38; ///< the number `infinity`

/// The result of an operator between numbers, as Context Free computes it.
double binary(const std::string& sign, double a, double b);

} // namespace graftal::cfdg
