#include "runtime/studio/binary_message.h"

#include <array>

namespace graftal {

namespace {

constexpr std::uint32_t tile_mark = 0x4c495447, file_mark = 0x4c494647; // "GTIL", "GFIL"

using Words = std::array<std::uint32_t, 8>;

std::string message(const Words& words, std::string_view deflated) {
    std::string text;
    text.reserve(sizeof(Words) + deflated.size());
    for (const std::uint32_t word : words)
        for (int shift = 0; shift < 32; shift += 8)
            text += static_cast<char>(word >> shift & 0xffu);
    return text.append(deflated);
}

std::uint32_t word(int number) {
    return static_cast<std::uint32_t>(number);
}

std::uint32_t word_at(std::string_view message, std::size_t index) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word |= std::uint32_t{static_cast<unsigned char>(message[4 * index + i])} << 8 * i;
    return word;
}

} // namespace

std::optional<std::uint32_t> state_of_tile(std::string_view message) {
    if (message.size() < sizeof(Words) || word_at(message, 0) != tile_mark) return std::nullopt;
    const std::uint32_t number = word_at(message, 1);
    return number < first_ask_id ? std::optional(number) : std::nullopt;
}

std::string tile_message(const TileHead& head, std::string_view deflated) {
    const Tile& tile = head.tile;
    return message({tile_mark, head.number, head.pass, word(tile.x), word(tile.y), word(tile.width),
                    word(tile.height), word(head.block)},
                   deflated);
}

std::string file_message(std::uint32_t id, std::size_t name_bytes, std::string_view deflated) {
    return message({file_mark, id, static_cast<std::uint32_t>(name_bytes), 0, 0, 0, 0, 0}, deflated);
}

} // namespace graftal
