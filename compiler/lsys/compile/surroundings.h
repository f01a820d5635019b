#pragma once

#include <optional>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/parse/ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/syntax/token_stream.h"

// The statements of a block that say what acts upon the turtle from outside: `tropism`, `bending`,
// `environment`.

namespace graftal {

/// `after segments`, `after moves` or `before moves`; nothing after an error.
std::optional<LsysBending> parse_bending(TokenStream& stream, Span keyword);
/// A kind and its numbers; nothing after an error.
std::optional<LsysEnvironment> parse_environment(TokenStream& stream);

/// Their values in the grammar, whose `lets` are known. Reports what is wrong.
void build_surroundings(const LsysBlock& block, LsysGrammar& grammar, Diagnostics& diagnostics);

} // namespace graftal
