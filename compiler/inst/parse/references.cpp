#include "compiler/inst/parse/references.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/inst/parse/repeat.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

/// Numbers in parentheses, or the name of a file in quotes, with or without them; or nothing.
bool parse_arguments_of(TokenStream& stream, InstReference& reference) {
    const bool open = stream.at("(");
    if (stream.peek(open ? 1 : 0).kind != TokenKind::string)
        return !stream.accept("(") || parse_arguments(stream, reference.arguments);
    stream.accept("(");
    const Token path = stream.next();
    reference.path = path.text;
    reference.path_span = path.span;
    return !open || stream.expect(")", path.text);
}

/// A comma may also end a line.
bool goes_on(const TokenStream& stream) {
    const Token& after = stream.peek(1);
    return stream.at(",") && after.kind == TokenKind::name &&
           !(is_body_keyword(after) && stream.peek(2).is(":"));
}

} // namespace

bool parse_inst_references(TokenStream& stream, std::vector<InstReference>& references,
                           std::string_view keyword) {
    do {
        const bool keyword_next = stream.peek(1).is(":") && is_body_keyword(stream.peek());
        if (!stream.at_name() || keyword_next) {
            const std::string after(references.empty() ? keyword : stream.previous().text);
            const bool block = stream.at("{");
            Diagnostic& error = stream.expected(fmt::format("the name of an object after '{}'", after));
            if (block) error.with_hint(fmt::format("write names without braces: '{}: sphere, cube'", after));
            return false;
        }
        InstReference reference;
        const Token name = stream.next();
        reference.name = name.text;
        if (!parse_arguments_of(stream, reference)) return false;
        reference.span = stream.span_from(name.span);
        references.push_back(std::move(reference));
    } while (goes_on(stream) && stream.accept(","));
    return true;
}

} // namespace graftal
