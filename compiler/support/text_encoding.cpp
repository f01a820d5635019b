#include "compiler/support/text_encoding.h"

#include <array>
#include <cstddef>
#include <string_view>

#include "compiler/support/printable.h"

namespace graftal {

namespace {

constexpr char32_t unreadable = 0xFFFD;

void append_utf8(std::string& text, char32_t c) {
    const auto put = [&](char32_t byte) { text += static_cast<char>(byte); };
    const auto tail = [&](int shift) { put(0x80 | ((c >> shift) & 0x3F)); };
    if (c < 0x80) return put(c);
    if (c < 0x800) return put(0xC0 | c >> 6), tail(0);
    if (c < 0x10000) return put(0xE0 | c >> 12), tail(6), tail(0);
    put(0xF0 | c >> 18), tail(12), tail(6), tail(0);
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
    std::string text;
    const auto unit = [&](std::size_t at) {
        const auto first = static_cast<unsigned char>(bytes[at]),
                   second = static_cast<unsigned char>(bytes[at + 1]);
        return static_cast<char32_t>(big_endian ? first << 8 | second : second << 8 | first);
    };
    for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
        char32_t c = unit(at);
        const bool leads = c >= 0xD800 && c < 0xDC00, trails = c >= 0xDC00 && c < 0xE000;
        const char32_t next = leads && at + 3 < bytes.size() ? unit(at + 2) : 0;
        if (next >= 0xDC00 && next < 0xE000) {
            c = 0x10000 + ((c - 0xD800) << 10) + (next - 0xDC00);
            at += 2;
        } else if (leads || trails) {
            c = unreadable;
        }
        append_utf8(text, c);
    }
    if (bytes.size() % 2 != 0) append_utf8(text, unreadable);
    return text;
}

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const CodePoint point = code_point(text, at);
        if (point.value == CodePoint::invalid) return false;
        at += point.size;
    }
    return true;
}

std::string from_windows_1252(std::string_view bytes) {
    static constexpr std::array<char32_t, 32> middle = {
        0x20AC, 0x0081, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
        0x2039, 0x0152, 0x008D, 0x017D, 0x008F, 0x0090, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
        0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x009D, 0x017E, 0x0178};
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        append_utf8(text, byte >= 0x80 && byte < 0xA0 ? middle[byte - 0x80] : byte);
    }
    return text;
}

void end_lines_plainly(std::string& text) {
    std::size_t end = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const bool is_return = text[at] == '\r';
        if (is_return && at + 1 < text.size() && text[at + 1] == '\n') continue;
        text[end++] = is_return ? '\n' : text[at];
    }
    text.resize(end);
    while (text.ends_with('\x1a'))
        text.pop_back();
}

} // namespace

std::string decoded_text(std::string bytes, OtherBytes others) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\xEF\xBB\xBF"sv))
        bytes.erase(0, 3);
    else if (bytes.starts_with("\xFF\xFE"sv) || bytes.starts_with("\xFE\xFF"sv))
        bytes = from_utf16(std::string_view(bytes).substr(2), bytes[0] == '\xFE');
    else if (others == OtherBytes::windows_1252 && !is_utf8(bytes))
        bytes = from_windows_1252(bytes);
    end_lines_plainly(bytes);
    return bytes;
}

} // namespace graftal
