#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/trace/tile.h"

namespace graftal {

/// The eight numbers before the bytes of a tile (docs/studio.md).
struct TileHead {
    std::uint32_t number = 0; ///< of the state, or a thumbnail's id
    std::uint32_t pass = 0;
    Tile tile;     ///< in pixels of the picture
    int block = 1; ///< pixels that a sample stands for, along each side
};

/// A binary message of rows of samples of red, green and blue, which are `deflated` (StudioHome::deflated()).
std::string tile_message(const TileHead& head, std::string_view deflated);

/// Asks have ids from here on; numbers of states are below.
inline constexpr std::uint32_t first_ask_id = 1u << 30u;

/// The number of the state that a binary message is a tile of; nothing for thumbnails and files.
std::optional<std::uint32_t> state_of_tile(std::string_view message);

/// A binary message of a file: its name of so many bytes, then its contents, together `deflated`.
std::string file_message(std::uint32_t id, std::size_t name_bytes, std::string_view deflated);

} // namespace graftal
