#include "compiler/support/printable.h"

#include <fmt/format.h>

namespace graftal {

namespace {

bool continues(std::string_view text, std::size_t at) {
    return at < text.size() && (text[at] & 0xC0) == 0x80;
}

void append_escaped(std::string& out, std::string_view text, bool in_lines = false) {
    for (std::size_t at = 0; at < text.size();) {
        const CodePoint character = code_point(text, at);
        if (!is_control(character) || (in_lines && character.value == '\n'))
            out += text.substr(at, character.size);
        else if (character.value == '\n')
            out += "\\n";
        else if (character.value == '\t')
            out += ' ';
        else if (character.value == CodePoint::invalid || character.value < 0x80)
            out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
        else
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(character.value));
        at += character.size;
    }
}

} // namespace

CodePoint code_point(std::string_view text, std::size_t at) {
    const auto lead = static_cast<unsigned char>(text[at]);
    if (lead < 0x80) return {lead, 1};
    const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4) return {};
    char32_t value = lead & (0x7F >> size);
    for (std::size_t i = 1; i < size; ++i) {
        if (!continues(text, at + i)) return {};
        value = value << 6 | (static_cast<unsigned char>(text[at + i]) & 0x3F);
    }
    const bool overlong = (size == 3 && value < 0x800) || (size == 4 && value < 0x10000);
    const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
    if (overlong || surrogate || value > 0x10FFFF) return {};
    return {value, size};
}

bool is_control(CodePoint character) {
    const char32_t c = character.value;
    if (c < 0x20 || (c >= 0x7F && c < 0xA0) || c == CodePoint::invalid) return true;
    const bool turns = c == 0x061C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) ||
                       (c >= 0x2066 && c <= 0x2069);
    const bool unseen = c == 0x200B || c == 0x2060 || c == 0xFEFF;
    return turns || unseen || c == 0x2028 || c == 0x2029;
}

bool is_printable(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const CodePoint character = code_point(text, at);
        if (is_control(character)) return false;
        at += character.size;
    }
    return true;
}

std::string masked(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const CodePoint character = code_point(text, at);
        // Columns count the bytes that begin a character; one that continues nothing has no column.
        if (!is_control(character))
            out += text.substr(at, character.size);
        else if (character.value != CodePoint::invalid || !continues(text, at))
            out += character.value == '\t' ? ' ' : '?';
        at += character.size;
    }
    return out;
}

std::string escaped(std::string_view text, std::size_t longest) {
    std::string out;
    if (text.size() <= longest) {
        append_escaped(out, text);
        return out;
    }
    std::size_t head = longest * 2 / 3, tail = text.size() - longest / 3;
    while (head > 0 && continues(text, head))
        --head;
    while (continues(text, tail))
        ++tail;
    append_escaped(out, text.substr(0, head));
    out += "...";
    append_escaped(out, text.substr(tail));
    return out;
}

std::string escaped_lines(std::string_view text) {
    std::string out;
    append_escaped(out, text, true);
    return out;
}

} // namespace graftal
