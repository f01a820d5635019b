#pragma once

#include <cstddef>

#include "compiler/inst/parse/ast.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// Parses the lines of an object, from its '{', which was just taken, to its '}', into `definition`. It
/// reports errors. `scatters`: how many there are in the file so far. False if the '}' is missing.
bool parse_inst_body(TokenStream& stream, InstDefinition& definition, std::size_t& scatters);

} // namespace graftal
