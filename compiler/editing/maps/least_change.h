#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace graftal {

/// The values that are to become zero, as a function of the numbers; nothing for numbers that are not
/// allowed.
using Residual = std::function<std::optional<std::vector<double>>(const std::vector<double>& numbers)>;

/// Numbers for which the residual is zero to within `tolerance` in each entry, near to the first ones:
/// Newton's method, each step the least in `units` that cancels the residual to first order (by the
/// pseudo-inverse; Ben-Israel 1966), and halved while it makes things worse. Nothing where that does not get
/// there. Deterministic; at most some hundred calls a number.
std::optional<std::vector<double>> solve_by_least_change(std::vector<double> numbers,
                                                         const std::vector<double>& units,
                                                         const Residual& residual, double tolerance);

} // namespace graftal
