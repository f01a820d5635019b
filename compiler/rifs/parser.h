#pragma once

#include <array>
#include <string_view>

#include "compiler/rifs/ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/foreign_words.h"

namespace graftal {

/// Parses a `.rifs` file; errors are reported, and the tree holds what could be read. Names are not looked
/// up. O(text).
RifsFile parse_rifs(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                    const ForeignWords& foreign = {});

/// The words that begin its statements, apart from those of scene statements.
inline constexpr std::array<std::string_view, 4> rifs_keywords = {"rifs", "main", "use", "orbit"};

} // namespace graftal
