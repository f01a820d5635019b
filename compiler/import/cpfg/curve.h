#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace graftal {

/// A curve in space by points at even distances along it.
struct CpfgCurve {
    std::array<std::vector<double>, 3> points; ///< x, y, z
    double length = 0;
};

/// The curve that a file of cuspy or funcedit holds (`.con`): a uniform cubic B-spline; nothing for other
/// kinds.
std::optional<CpfgCurve> read_cpfg_curve(std::string_view text);

} // namespace graftal
