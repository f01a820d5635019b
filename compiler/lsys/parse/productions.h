#pragma once

#include <optional>

#include "compiler/lsys/parse/ast.h"
#include "compiler/lsys/parse/strings.h"

namespace graftal {

/// Parses a statement as a production, or reports what is wrong with it and gives nothing. Outside of the
/// section `block` it must not have contexts.
std::optional<LsysProduction> parse_lsys_production(const LsysStatement& statement, LsysText& text);

} // namespace graftal
