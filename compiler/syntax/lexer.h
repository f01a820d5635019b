#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

enum class TokenKind : std::uint8_t { name, number, string, symbol, end };

/// One token. Names are [A-Za-z_][A-Za-z0-9_]* with inner dots (`leaf.llr`); numbers
/// are decimal (`2`, `.16`, `1e-3`); strings are in double quotes without escapes; symbols are one
/// character, or one of `-> == != <= >= && || ..`. Two dots end a number: `0..360` is three tokens.
struct Token {
    TokenKind kind = TokenKind::end;
    bool first_on_line = false; ///< no token before it on its line
    bool space_before = false;  ///< white space or a comment before it: `-1` against `- 1` in a row of codes
    Span span;
    std::string_view text; ///< the token's bytes (a string without its quotes)
    double number = 0;     ///< of a number

    bool is(std::string_view symbol_or_name) const {
        return (kind == TokenKind::symbol || kind == TokenKind::name) && text == symbol_or_name;
    }
};

/// Splits a file into tokens; the last is always `end`. Comments are `# ...`, `// ...` and `/* ... */`.
/// Bytes that start no token, unclosed strings and comments, and numbers that overflow are errors; lexing
/// goes on after them. O(text).
std::vector<Token> lex(const SourceMap& sources, FileId file, Diagnostics& diagnostics);

/// Splits a part of a file into tokens, with spans in the file, as if nothing stood around it.
std::vector<Token> lex_range(const SourceMap& sources, Span range, Diagnostics& diagnostics);

/// The tokens of the first few KiB of a file, to tell what it is before a front-end reads all of it. Errors
/// are left out, and the last token may be cut.
std::vector<Token> lex_beginning(const SourceMap& sources, FileId file);

} // namespace graftal
