#include "runtime/image_files/png_chunks.h"

#include <boost/crc.hpp>

namespace graftal {

namespace {

constexpr std::size_t frame_bytes = 12; // length, type and checksum

std::uint32_t checksum(std::string_view type_and_data) {
    boost::crc_32_type crc;
    crc.process_bytes(type_and_data.data(), type_and_data.size());
    return crc.checksum();
}

std::uint32_t number_at(std::string_view text, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
        number = number << 8 | static_cast<unsigned char>(text[at + i]);
    return number;
}

} // namespace

std::optional<std::vector<PngChunk>> png_chunks(std::string_view file) {
    if (!file.starts_with(png_signature)) return std::nullopt;
    file.remove_prefix(png_signature.size());
    std::vector<PngChunk> chunks;
    while (!file.empty()) {
        if (file.size() < frame_bytes) return std::nullopt;
        const std::size_t length = number_at(file, 0);
        if (length > file.size() - frame_bytes) return std::nullopt;
        if (number_at(file, 8 + length) != checksum(file.substr(4, 4 + length))) return std::nullopt;
        chunks.push_back({file.substr(4, 4), file.substr(8, length)});
        file.remove_prefix(frame_bytes + length);
    }
    if (chunks.size() < 2 || chunks.front().type != "IHDR" || chunks.back().type != "IEND")
        return std::nullopt;
    return chunks;
}

std::optional<std::string> png_text(const std::vector<PngChunk>& chunks, std::string_view keyword) {
    for (const PngChunk& chunk : chunks) {
        const std::size_t end = chunk.data.find('\0');
        if (chunk.type == "tEXt" && end != std::string_view::npos && chunk.data.substr(0, end) == keyword)
            return std::string(chunk.data.substr(end + 1));
    }
    return std::nullopt;
}

std::string png_chunk(std::string_view type, std::string_view data) {
    const std::string body = std::string(type) + std::string(data);
    return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(checksum(body));
}

std::string big_endian(std::uint32_t number, int bytes) {
    std::string text;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
        text += static_cast<char>(number >> shift & 0xff);
    return text;
}

} // namespace graftal
