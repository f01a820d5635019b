#pragma once

#include <array>
#include <string_view>

#include "compiler/lsys/parse/ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/foreign_words.h"

namespace graftal {

/// Parses a `.lsys` file; errors are reported, and the tree holds what could be read. Names in expressions
/// and models are not looked up. O(text).
LsysFile parse_lsys(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                    const ForeignWords& foreign = {});

/// The words that begin its statements, apart from those of scene statements.
inline constexpr std::array<std::string_view, 3> lsys_file_keywords = {"lsys", "main", "use"};

} // namespace graftal
