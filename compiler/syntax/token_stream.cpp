#include "compiler/syntax/token_stream.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/check.h"
#include "compiler/syntax/everyday_words.h"

namespace graftal {

namespace {

constexpr std::size_t longest_shown = 40;
constexpr const char* name_hint = "a name consists of letters, digits and _, and does not begin with a digit";

bool opens(const Token& token) {
    return token.is("{") || token.is("(") || token.is("[");
}
bool closes(const Token& token) {
    return token.is("}") || token.is(")") || token.is("]");
}

/// The text, or its first longest_shown bytes at most, cut between characters.
std::string shown(std::string_view text) {
    if (text.size() <= longest_shown) return std::string(text);
    std::size_t size = longest_shown;
    while (size > 0 && (text[size] & 0xC0) == 0x80)
        --size;
    return std::string(text.substr(0, size)) + "...";
}

} // namespace

TokenStream::TokenStream(std::vector<Token> tokens, Diagnostics& diagnostics, std::string_view end_name)
    : tokens_(std::move(tokens)), diagnostics_(diagnostics), end_name_(end_name) {
    GRAFTAL_CHECK(!tokens_.empty() && tokens_.back().kind == TokenKind::end, "tokens without an end");
    check_nesting();
}

void TokenStream::check_nesting() {
    std::size_t depth = 0;
    for (const Token& token : tokens_) {
        if (opens(token)) ++depth;
        if (closes(token) && depth > 0) --depth;
        if (depth <= max_nesting) continue;
        diagnostics_.error(token.span, fmt::format("brackets nest more than {} deep", max_nesting));
        tokens_.erase(tokens_.begin(), tokens_.end() - 1);
        return;
    }
}

bool TokenStream::is_statement_word(const Token& token) const {
    return token.kind == TokenKind::name &&
           std::ranges::find(statement_words_, token.text) != statement_words_.end();
}

bool TokenStream::is_line_word(const Token& token) const {
    return token.kind == TokenKind::name && std::ranges::find(line_words_, token.text) != line_words_.end();
}

void TokenStream::drop_semicolons() {
    bool reported = false, first_on_line = false;
    std::size_t kept = 0;
    for (Token& token : tokens_) {
        const bool semicolon = token.is(";");
        if (semicolon && !reported)
            diagnostics_.error(token.span, "no statement ends with ';'")
                .with_hint("remove every ';': a statement ends with its line, or where the next one begins");
        reported |= semicolon;
        first_on_line |= token.first_on_line;
        if (semicolon) continue;
        token.first_on_line = first_on_line;
        first_on_line = false;
        tokens_[kept++] = token;
    }
    tokens_.resize(kept);
}

const Token& TokenStream::peek(std::size_t ahead) const {
    return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
}

const Token& TokenStream::next() {
    const Token& token = peek();
    if (at_ + 1 < tokens_.size()) ++at_;
    return token;
}

bool TokenStream::accept(std::string_view symbol_or_name) {
    if (!at(symbol_or_name)) return false;
    next();
    return true;
}

bool TokenStream::expect(std::string_view symbol_or_name, std::string_view after) {
    if (accept(symbol_or_name)) return true;
    Diagnostic& error =
        expected(after.empty() ? fmt::format("'{}'", symbol_or_name)
                               : fmt::format("'{}' after '{}'", symbol_or_name, shown(after)));
    if (at("-") && previous().kind == TokenKind::name && !peek().space_before) error.with_hint(name_hint);
    return false;
}

std::optional<Token> TokenStream::expect_name(std::string_view what) {
    if (at_name()) return next();
    Diagnostic& error = expected(what);
    if (peek().kind == TokenKind::number) error.with_hint(name_hint);
    if (peek().kind == TokenKind::string) error.with_hint("write names without quotes");
    return std::nullopt;
}

std::optional<Token> TokenStream::expect_string(std::string_view what) {
    if (peek().kind == TokenKind::string) return next();
    Diagnostic& error = expected(what);
    if (at_name()) error.with_hint(fmt::format("write \"{}\"", shown(peek().text)));
    return std::nullopt;
}

Diagnostic& TokenStream::expected(std::string_view what) {
    return diagnostics_.error(peek().span, fmt::format("expected {}, found {}", what, found()))
        .with_hint(at_ == 0 ? "" : lost_product_hint(previous(), peek()));
}

std::string TokenStream::found() const {
    const Token& token = peek();
    switch (token.kind) {
    case TokenKind::end:
        return std::string(end_name_);
    case TokenKind::string:
        return fmt::format("the string \"{}\"", shown(token.text));
    default:
        return fmt::format("'{}'", shown(token.text));
    }
}

void TokenStream::skip_line() {
    while (!at_end() && !at("}") && !peek().first_on_line)
        if (next().is("{")) skip_block();
}

void TokenStream::skip_block() {
    for (std::size_t depth = 1; depth > 0 && !at_end();) {
        const Token& token = next();
        if (token.is("{")) ++depth;
        if (token.is("}")) --depth;
    }
}

} // namespace graftal
