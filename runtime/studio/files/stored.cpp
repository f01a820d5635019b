#include "runtime/studio/files/stored.h"

#include <algorithm>
#include <cstdint>

namespace graftal {

namespace {

std::uint32_t adler32(std::string_view bytes) {
    constexpr std::uint32_t modulus = 65521;
    constexpr std::size_t safe_bytes = 5552; // that `second` holds without a remainder
    std::uint32_t first = 1, second = 0;
    for (std::size_t at = 0; at < bytes.size(); at += safe_bytes) {
        for (const char byte : bytes.substr(at, safe_bytes)) {
            first += static_cast<unsigned char>(byte);
            second += first;
        }
        first %= modulus;
        second %= modulus;
    }
    return second << 16 | first;
}

void add_u16(std::string& text, std::size_t number) {
    text += static_cast<char>(number & 0xffu);
    text += static_cast<char>(number >> 8 & 0xffu);
}

} // namespace

std::string stored(std::string_view bytes) {
    constexpr std::size_t most_of_block = 65535;
    std::string text = "\x78\x01";
    text.reserve(bytes.size() + 5 * (bytes.size() / most_of_block + 1) + 6);
    std::size_t at = 0;
    do {
        const std::string_view block = bytes.substr(at, most_of_block);
        at += block.size();
        text += at == bytes.size() ? '\x01' : '\0';
        add_u16(text, block.size());
        add_u16(text, ~block.size());
        text += block;
    } while (at < bytes.size());
    const std::uint32_t sum = adler32(bytes);
    for (int shift = 24; shift >= 0; shift -= 8)
        text += static_cast<char>(sum >> shift & 0xffu);
    return text;
}

} // namespace graftal
