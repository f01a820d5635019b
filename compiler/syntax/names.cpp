#include "compiler/syntax/names.h"

namespace graftal {

std::optional<Name> parse_name(TokenStream& stream, std::string_view what) {
    const std::optional<Token> name = stream.expect_name(what);
    if (!name) return std::nullopt;
    return Name{name->text, name->span};
}

std::optional<UseStatement> parse_use(TokenStream& stream) {
    stream.next();
    const std::optional<Name> name = parse_name(stream, "a name after 'use'");
    if (!name || !stream.expect("=", name->text)) return std::nullopt;
    const std::optional<Token> path = stream.expect_string("the file name in quotes");
    if (!path) return std::nullopt;
    return UseStatement{*name, path->text, path->span};
}

} // namespace graftal
