#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/importer.h"

namespace graftal::eisenscript {

enum class TokenKind : std::uint8_t { word, number, open, close, times, more, end };

/// A word, a number or a sign of the text after its `#define`s.
struct Token {
    TokenKind kind = TokenKind::end;
    std::string text;    ///< in small letters
    std::string written; ///< as it stands
    double number = 0;
    bool whole = false;                ///< a number without fraction
    std::string constant;              ///< the `#define` that gave all of the number; "" if none did
    Span span;                         ///< in the file
    std::vector<std::string> comments; ///< comments before it

    bool is(std::string_view word) const { return kind == TokenKind::word && text == word; }
};

/// `#define angle 6` whose text is a number.
struct Constant {
    std::string name;
    double number = 0;
    Span span;
    std::string remark; ///< such as its range
};

struct Tokens {
    std::vector<Token> list; ///< ends with an end token
    std::vector<Constant> constants;
};

/// Structure Synth's preprocessor and tokenizer. Reports what cannot be read.
Tokens tokenize(const ForeignFile& file);

} // namespace graftal::eisenscript
