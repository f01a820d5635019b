#include "compiler/editing/positions.h"

#include <algorithm>

#include "compiler/support/printable.h"

namespace graftal {

namespace {

/// UTF-16 units of a character: characters beyond U+FFFF have two.
std::uint32_t units_of(CodePoint character) {
    return character.value != CodePoint::invalid && character.value > 0xFFFF ? 2 : 1;
}

} // namespace

TextPositions::TextPositions(std::string_view text) : text_(text) {
    lines_.push_back({});
    std::uint32_t units = 0;
    for (std::size_t at = 0; at < text.size();) {
        const CodePoint character = code_point(text, at);
        units += units_of(character);
        at += character.size;
        if (character.value == U'\n') lines_.push_back({static_cast<std::uint32_t>(at), units});
    }
}

const TextPositions::Line& TextPositions::line_at(std::uint32_t byte) const {
    const auto next = std::ranges::upper_bound(lines_, byte, {}, &Line::byte);
    return *(next - 1);
}

std::uint32_t TextPositions::utf16_of(std::uint32_t byte) const {
    const Line& line = line_at(byte);
    std::uint32_t units = line.utf16;
    for (std::size_t at = line.byte; at < text_.size();) {
        const CodePoint character = code_point(text_, at);
        at += character.size;
        if (at > byte) break;
        units += units_of(character);
    }
    return units;
}

std::uint32_t TextPositions::byte_of(std::uint32_t utf16) const {
    const auto next = std::ranges::upper_bound(lines_, utf16, {}, &Line::utf16);
    std::uint32_t units = (next - 1)->utf16;
    std::size_t at = (next - 1)->byte;
    while (at < text_.size()) {
        const CodePoint character = code_point(text_, at);
        units += units_of(character);
        if (units > utf16) break;
        at += character.size;
    }
    return static_cast<std::uint32_t>(at);
}

LinePosition TextPositions::line_position(std::uint32_t byte) const {
    const Line& line = line_at(byte);
    return {static_cast<std::uint32_t>(&line - lines_.data()), utf16_of(byte) - line.utf16};
}

std::uint32_t TextPositions::byte_of(LinePosition position) const {
    if (position.line >= lines_.size()) return static_cast<std::uint32_t>(text_.size());
    const std::uint32_t first = lines_[position.line].utf16;
    const bool is_last = position.line + 1 == lines_.size();
    const std::uint32_t end = is_last ? utf16_of(static_cast<std::uint32_t>(text_.size()))
                                      : lines_[position.line + 1].utf16 - 1; // before its '\n'
    return byte_of(first + std::min(position.character, end - first));
}

} // namespace graftal
