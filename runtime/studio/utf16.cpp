#include "runtime/studio/utf16.h"

#include <algorithm>

namespace graftal {

namespace {

struct Character {
    std::size_t bytes = 1, units = 1;
};

bool is_continuation(char byte) {
    return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80u;
}

Character character_at(std::string_view text, std::size_t at) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const std::size_t bytes = lead >= 0xf0 && lead < 0xf8 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 1;
    if (lead < 0xc0 || lead >= 0xf8 || at + bytes > text.size()) return {};
    for (std::size_t i = 1; i < bytes; ++i)
        if (!is_continuation(text[at + i])) return {};
    return {bytes, bytes == 4 ? std::size_t{2} : std::size_t{1}};
}

} // namespace

std::size_t utf16_offset(std::string_view text, std::size_t bytes) {
    bytes = std::min(bytes, text.size());
    std::size_t units = 0;
    for (std::size_t at = 0; at < bytes;) {
        const Character character = character_at(text, at);
        at += character.bytes;
        units += character.units;
    }
    return units;
}

std::size_t byte_offset(std::string_view text, std::size_t units) {
    std::size_t at = 0;
    for (std::size_t before = 0; at < text.size() && before < units;) {
        const Character character = character_at(text, at);
        at += character.bytes;
        before += character.units;
    }
    return at;
}

} // namespace graftal
