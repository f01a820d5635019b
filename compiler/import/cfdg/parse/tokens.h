#pragma once

#include <string>
#include <vector>

#include "compiler/import/importer.h"

namespace graftal::cfdg {

enum class TokenKind : std::uint8_t { word, number, text, sign, end };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string text; ///< of a string without its quotes; "|sat" is one word
    double number = 0;
    bool percent = false;
    Span span;
    std::vector<std::string> comments; ///< comments before it

    bool is(std::string_view other) const {
        return (kind == TokenKind::word || kind == TokenKind::sign) && text == other;
    }
};

/// Ends with an end token. Reports characters that no token begins with.
std::vector<Token> tokenize(const ForeignFile& file);

} // namespace graftal::cfdg
