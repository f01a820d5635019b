#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graftal {

// PNG files taken apart and put together (W3C, Portable Network Graphics, third edition: 5 Datastream
// structure, which has animated ones too). Pixels stay compressed; what they mean is png_files.h's business.

struct PngChunk {
    std::string_view type; ///< four letters
    std::string_view data;
};

/// The chunks of a whole file, IHDR first and IEND last. Nothing if anything is missing or damaged.
std::optional<std::vector<PngChunk>> png_chunks(std::string_view file);

/// The text under a keyword (chunk tEXt), or nothing.
std::optional<std::string> png_text(const std::vector<PngChunk>& chunks, std::string_view keyword);

inline constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

/// A chunk as it stands in a file: length, type, data, checksum.
std::string png_chunk(std::string_view type, std::string_view data);

/// A number as PNG has them, most significant byte first.
std::string big_endian(std::uint32_t number, int bytes = 4);

} // namespace graftal
