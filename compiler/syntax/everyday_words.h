#pragma once

#include <string>
#include <string_view>

#include "compiler/syntax/lexer.h"

namespace graftal {

/// "write 'cube'" for `box`, a word for a shape; "" for words that are none. Capitals do not count.
std::string shape_word_hint(std::string_view word);
/// "write 'translate: 1, 0, 0'" for `move`, a word for a line of an instance or a map; likewise.
std::string line_word_hint(std::string_view word);
/// Whether the word is a shape or a combination that POV-Ray writes before braces: `sphere { <0, 0, 0>, 1 }`.
bool is_braced_word(std::string_view word);
/// How an object is written whose name stands before a '{'. `around`: "...", or with what stands around the
/// object.
std::string braced_word_hint(std::string_view word, std::string_view around);
/// "write 0.78*s" between the two tokens of `0.78s`, where an expression ends too early; else "".
std::string lost_product_hint(const Token& before, const Token& token);

} // namespace graftal
