#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/lsys/parse/ast.h"
#include "compiler/support/source.h"
#include "compiler/syntax/token_stream.h"

// Statements of a block whose first words, `bending` or `environment`, are read already.

namespace graftal {

/// The words that may follow `environment`.
std::vector<std::string_view> environment_kinds();

/// `after segments`, `after moves` or `before moves`; nothing after an error.
std::optional<LsysBending> parse_bending(TokenStream& stream, Span keyword);
/// A kind and its numbers; nothing after an error.
std::optional<LsysEnvironment> parse_environment(TokenStream& stream);

} // namespace graftal
