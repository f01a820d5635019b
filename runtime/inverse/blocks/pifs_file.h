#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/inverse/blocks/block_map.h"

namespace graftal {

// A .pifs file holds the letters PIFS, a byte with the version, 1, and one Zstandard frame (RFC 8878) with
// the size of its content and its checksum. Numbers of the content have the least byte first:
//
//     kind       1 byte: 0 grey, 1 colour; and 2 more with alpha
//     pool       1 byte: each pool has the finest lattice with at most 2^pool domains
//     size       2 bytes: width, 2 bytes: height
//     divisions  bits, the lowest of a byte first: whether squares are divided, as walk_partition() asks
//     maps       a byte a block: 0 flat; else 1 + isometry + 8 * (slope < 0) + 16 * (|slope| - 1)
//     levels     a byte a block: the level less the one foretold, modulo 256. That is of the blocks to the
//                left and above the mean, or either, or 128. Both count in steps of 2 from -128 where a block
//                has a slope, and in steps of 1 from 0 (down to 0, up to 255) where it is flat
//     addresses  the low bytes of all domains, then the high bytes
//
// Each of the last four has the numbers of all planes, one plane after the other.

inline constexpr char pifs_version = 1;

/// A file with this content, whatever it says; each part is compressed by its own statistics.
std::string pifs_around(std::span<const std::string> parts);

/// The file of a picture.
std::string pifs_text(const BlockPicture& picture);

/// Reads a file; nothing where it is faulty, with the reason in `fault`. Memory for its content is at most
/// `memory_bytes`, and time goes with the size of its picture.
std::optional<BlockPicture> read_pifs(std::string_view text, std::uint64_t memory_bytes, std::string& fault);

} // namespace graftal
