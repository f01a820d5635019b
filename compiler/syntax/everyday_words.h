#pragma once

#include <span>
#include <string>
#include <string_view>

namespace graftal {

/// A word of everyday English, or of another program, for what the languages call otherwise.
struct EverydayWord {
    std::string_view word;  ///< in small letters
    std::string_view meant; ///< a primitive or a keyword
    std::string_view how;   ///< what to write
};

/// Words for shapes: `box` for `cube`.
std::span<const EverydayWord> everyday_shape_words();
/// Words for lines of an instance or a map: `move` for `translate`.
std::span<const EverydayWord> everyday_line_words();

/// "write 'cube'", or "" if the word is none of these. Capitals do not count.
std::string shape_word_hint(std::string_view word);
std::string line_word_hint(std::string_view word);

} // namespace graftal
