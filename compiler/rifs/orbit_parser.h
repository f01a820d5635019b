#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "compiler/rifs/orbit_ast.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// The words that begin its items, and those of its maps.
inline constexpr std::array<std::string_view, 13> orbit_words = {
    "map", "final", "follow", "start",       "skip", "restart", "let",
    "x",   "y",     "z",      "probability", "tint", "material"};

/// Parses `orbit NAME { ... }`, from its keyword on, into `orbits`; errors are reported. False where the
/// stream stands in a line that is at fault.
bool parse_orbit(TokenStream& stream, std::vector<OrbitBlock>& orbits);

} // namespace graftal
