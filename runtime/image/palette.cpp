#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <zlib.h>

#include "compiler/support/check.h"
#include "compiler/support/file.h"
#include "runtime/image/image.h"

// Not by OpenImageIO, whose libraries take longer to load than a palette takes to write; and not compressed,
// as little as the text of the scene beside it: most palettes are read once.

namespace graftal {

namespace {

void append(std::string& bytes, std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes += static_cast<char>(number >> shift);
}

void append(std::string& bytes, std::uint16_t number) {
    bytes += static_cast<char>(number >> 8);
    bytes += static_cast<char>(number);
}

const Bytef* bytes_of(const std::string& text) {
    return reinterpret_cast<const Bytef*>(text.data());
}

void append_chunk(std::string& png, const std::string& type, const std::string& data) {
    append(png, static_cast<std::uint32_t>(data.size()));
    png += type;
    png += data;
    const uLong begun = crc32(0, bytes_of(type), static_cast<uInt>(type.size()));
    append(png, static_cast<std::uint32_t>(crc32(begun, bytes_of(data), static_cast<uInt>(data.size()))));
}

std::string header(int width, int height) {
    std::string data;
    append(data, static_cast<std::uint32_t>(width));
    append(data, static_cast<std::uint32_t>(height));
    // 16 bits, RGB, and the only ways there are of packing, filtering and ordering.
    return data + std::string{16, 2, 0, 0, 0};
}

std::string gamma_of_linear() {
    std::string data;
    append(data, std::uint32_t{100'000});
    return data;
}

/// Each row behind the number of its filter: none.
std::string samples(int width, int height, std::span<const Rgb> pixels) {
    std::string data;
    data.reserve(static_cast<std::size_t>(height) * (1 + 6 * static_cast<std::size_t>(width)));
    std::size_t i = 0;
    for (int y = 0; y < height; ++y) {
        data += '\0';
        for (int x = 0; x < width; ++x, ++i) {
            const Rgb& rgb = pixels[std::min(i, pixels.size() - 1)];
            for (int c = 0; c < 3; ++c) {
                const float value = std::clamp(static_cast<float>(rgb[c]), 0.0f, 1.0f);
                append(data, static_cast<std::uint16_t>(65535 * value + 0.5f));
            }
        }
    }
    return data;
}

std::string stored(const std::string& data) {
    uLongf size = compressBound(data.size());
    std::string result(size, '\0');
    const int outcome = compress2(reinterpret_cast<Bytef*>(result.data()), &size, bytes_of(data), data.size(),
                                  Z_NO_COMPRESSION);
    GRAFTAL_CHECK(outcome == Z_OK, "zlib");
    result.resize(size);
    return result;
}

} // namespace

Status write_palette(const std::string& path, int width, int height, std::span<const Rgb> pixels) {
    const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    GRAFTAL_CHECK(!pixels.empty() && pixels.size() <= size, path);
    std::string png = "\x89PNG\r\n\x1a\n";
    append_chunk(png, "IHDR", header(width, height));
    append_chunk(png, "gAMA", gamma_of_linear());
    append_chunk(png, "IDAT", stored(samples(width, height, pixels)));
    append_chunk(png, "IEND", {});
    return write_text(path, png);
}

} // namespace graftal
