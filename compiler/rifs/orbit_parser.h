#pragma once

#include <vector>

#include "compiler/rifs/orbit_ast.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// Parses `orbit NAME { ... }`, from its keyword on, into `orbits`; errors are reported. False where the
/// stream stands in a line that is at fault.
bool parse_orbit(TokenStream& stream, std::vector<OrbitBlock>& orbits);

} // namespace graftal
