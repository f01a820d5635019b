#pragma once

#include <optional>
#include <string_view>

#include "compiler/support/source.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// A name where it stands. The text is a view of the source, which outlives the trees.
struct Name {
    std::string_view text;
    Span span;
};

/// `use NAME = "path"`.
struct UseStatement {
    Name name;
    std::string_view path;
    Span path_span;
};

/// Takes a name, or reports "expected WHAT, found ...".
std::optional<Name> parse_name(TokenStream& stream, std::string_view what);

/// Requires that the stream is at `use`. Errors are reported and give nothing.
std::optional<UseStatement> parse_use(TokenStream& stream);

} // namespace graftal
