#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace graftal {

/// A colour as the web writes it: `red` (the 147 names of SVG 1.1), `#rgb`, `#rrggbb`. Components in [0, 1],
/// as screens store them (sRGB).
std::optional<std::array<double, 3>> colour_named(std::string_view name);

} // namespace graftal
