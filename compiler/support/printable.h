#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace graftal {

/// One character of a text in UTF-8: the code point that begins at `at`, and how many bytes it has.
struct CodePoint {
    static constexpr char32_t invalid = 0xFFFFFFFF; ///< one byte that is no UTF-8

    char32_t value = invalid;
    std::size_t size = 1;
};

/// Requires at < text.size().
CodePoint code_point(std::string_view text, std::size_t at);

/// Texts come from strangers' files and reach a terminal. Control characters could move its cursor, give it
/// orders or turn the order of its letters round: C0, DEL, C1, marks of direction, line separators, and
/// bytes that are no UTF-8. Characters of no width are counted among them, since nobody sees them.
bool is_control(CodePoint character);

/// Whether a text is in UTF-8 and has no control character. Names that graftal writes are so: a line end in a
/// name would be a line of its own in a file or on a terminal.
bool is_printable(std::string_view text);

/// The text with one `?` for each control character, and a blank for each tab: columns stay where they are.
std::string masked(std::string_view text);

/// The text in one line: control characters as `\n`, `\x1b` or `\u202e`. A text longer than `longest` bytes
/// loses its middle.
std::string escaped(std::string_view text, std::size_t longest = 400);

/// The text with its lines escaped one by one, each at its full length.
std::string escaped_lines(std::string_view text);

} // namespace graftal
