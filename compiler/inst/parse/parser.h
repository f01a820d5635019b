#pragma once

#include <array>
#include <string_view>

#include "compiler/inst/parse/ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/foreign_words.h"

namespace graftal {

/// Parses an `.inst` file (grammar: docs/language.md). All syntax errors of the file are reported; after
/// errors the module holds what was understood.
InstModule parse_inst(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                      const ForeignWords& foreign = {});

/// The words that begin its statements, apart from those of scene statements.
inline constexpr std::array<std::string_view, 3> inst_keywords = {"object", "canonical", "use"};

} // namespace graftal
