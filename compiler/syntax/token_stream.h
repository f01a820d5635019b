#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/diagnostics.h"
#include "compiler/syntax/lexer.h"

namespace graftal {

/// A parser's view of a file's tokens: looking ahead, taking, expecting, and going on after an error.
///
/// A file that nests brackets deeper than max_nesting is reported once and reads as empty, so that parsers
/// may recurse over brackets.
class TokenStream {
  public:
    static constexpr std::size_t max_nesting = 256;

    /// `tokens` as lex() or lex_range() gives them; `end_name` is what messages call their end.
    TokenStream(std::vector<Token> tokens, Diagnostics& diagnostics,
                std::string_view end_name = "the end of the file");

    /// The words of the language that is read, of static storage, beside those that all languages share. What
    /// is read by rules that all share ends where one of them begins something else: a block of a scene
    /// statement at one of `statements`, a row of numbers without commas at one of `lines`.
    void set_words(std::span<const std::string_view> statements, std::span<const std::string_view> lines) {
        statement_words_ = statements;
        line_words_ = lines;
    }
    bool is_statement_word(const Token& token) const;
    bool is_line_word(const Token& token) const;

    /// Takes every ';' away, and reports the first: for languages that have none.
    void drop_semicolons();

    /// The token `ahead` places after the next one; past the end, the `end` token.
    const Token& peek(std::size_t ahead = 0) const;
    /// Takes a token; the `end` token is never used up.
    const Token& next();
    /// The token taken last; before any, the first one.
    const Token& previous() const { return tokens_[at_ == 0 ? 0 : at_ - 1]; }
    bool at_end() const { return peek().kind == TokenKind::end; }
    bool at(std::string_view symbol_or_name) const { return peek().is(symbol_or_name); }
    bool at_name() const { return peek().kind == TokenKind::name; }

    /// Takes the next token if it is this symbol or word.
    bool accept(std::string_view symbol_or_name);
    /// accept(), or the error "expected ':' after 'scale', found 'x'". `after` may be empty.
    bool expect(std::string_view symbol_or_name, std::string_view after = {});
    /// Takes a name, or reports "expected WHAT, found ...".
    std::optional<Token> expect_name(std::string_view what);
    /// Takes a string, or reports "expected WHAT, found ...".
    std::optional<Token> expect_string(std::string_view what);

    /// Reports "expected WHAT, found ..." at the next token.
    Diagnostic& expected(std::string_view what);
    /// The next token as messages show it: "'x'", "the string \"x\"", "the end of the file".
    std::string found() const;

    /// The span from a token taken earlier to the token taken last.
    Span span_from(const Span& first) const { return join(first, previous().span); }

    /// Skips the rest of a faulty line of a block, and blocks inside: to the next token that begins a line,
    /// or to the '}' that closes the block. Takes at least nothing: call it after taking a token.
    void skip_line();
    /// Skips past the '}' that closes the block just opened (or to the end).
    void skip_block();

    /// Where the parser stands; for measuring how many tokens a definition has, and for going back there.
    std::size_t position() const { return at_; }
    void go_back(std::size_t position) { at_ = position; }
    Diagnostics& diagnostics() { return diagnostics_; }

  private:
    void check_nesting();

    std::vector<Token> tokens_;
    Diagnostics& diagnostics_;
    std::string_view end_name_;
    std::span<const std::string_view> statement_words_, line_words_;
    std::size_t at_ = 0;
};

} // namespace graftal
