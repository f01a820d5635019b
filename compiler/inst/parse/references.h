#pragma once

#include <string_view>
#include <vector>

#include "compiler/inst/parse/ast.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// Adds the objects that a line names, `leaf(3), "tree.inst"`: each with numbers or the name of a file.
/// `keyword`: before them, for errors; it may be empty. False after an error, which it reports.
bool parse_inst_references(TokenStream& stream, std::vector<InstReference>& references,
                           std::string_view keyword);

} // namespace graftal
