#include "runtime/inverse/blocks/pifs_file.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <zstd.h>

#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr std::string_view magic = "PIFS";
constexpr int compression = 19;
constexpr unsigned mirror_code = 8, slope_code = 16;
/// Bytes of the blocks in memory, at most, while they are read: each of 4 by 4 pixels, in all planes.
constexpr std::uint64_t bytes_a_pixel = 12;

/// The fault of a file, in words.
struct PifsFault {
    std::string text;
};

/// The levels of the blocks so far, for each place of a plane.
class LevelGuess {
  public:
    explicit LevelGuess(const PlaneGrid& grid)
        : columns_(grid.padded_width() / least_side),
          levels_(static_cast<std::size_t>(columns_) *
                  static_cast<std::size_t>(grid.padded_height() / least_side)) {}

    /// In the steps of the block's kind.
    int guess(const BlockMap& block) const {
        const int x = block.x / least_side, y = block.y / least_side;
        const int left = x > 0 ? at(x - 1, y) : at_or(x, y - 1), above = y > 0 ? at(x, y - 1) : left;
        return steps((left + above) >> 1, block.slope != 0);
    }
    void put(const BlockMap& block) {
        for (int y = block.y / least_side; y < (block.y + block.side) / least_side; ++y)
            for (int x = block.x / least_side; x < (block.x + block.side) / least_side; ++x)
                levels_[index(x, y)] = static_cast<std::int16_t>(block.level);
    }

    static int steps(int level, bool sloped) {
        return sloped ? (level - lowest_level) / level_step : std::clamp(level, 0, 255);
    }
    static int level(int steps, bool sloped) { return sloped ? lowest_level + level_step * steps : steps; }

  private:
    static constexpr int first_guess = 128;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }
    int at(int x, int y) const { return levels_[index(x, y)]; }
    int at_or(int x, int y) const { return y >= 0 ? at(x, y) : first_guess; }

    int columns_;
    std::vector<std::int16_t> levels_;
};

/// One frame, whose parts may be compressed each by its own statistics.
class FrameWriter {
  public:
    explicit FrameWriter(std::size_t size) : context_(ZSTD_createCCtx()) {
        if (!context_) throw std::bad_alloc();
        checked(ZSTD_CCtx_setParameter(context_, ZSTD_c_compressionLevel, compression));
        checked(ZSTD_CCtx_setParameter(context_, ZSTD_c_checksumFlag, 1));
        checked(ZSTD_CCtx_setPledgedSrcSize(context_, size));
    }
    ~FrameWriter() { ZSTD_freeCCtx(context_); }
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    void add(const std::string& part, bool last, std::string& out) {
        ZSTD_inBuffer in{part.data(), part.size(), 0};
        std::string room(ZSTD_CStreamOutSize(), '\0');
        for (std::size_t left = 1; left > 0 || in.pos < in.size;) {
            ZSTD_outBuffer to{room.data(), room.size(), 0};
            left = checked(ZSTD_compressStream2(context_, &to, &in, last ? ZSTD_e_end : ZSTD_e_flush));
            out.append(room, 0, to.pos);
        }
    }

  private:
    static std::size_t checked(std::size_t result) {
        GRAFTAL_CHECK(!ZSTD_isError(result), ZSTD_getErrorName(result));
        return result;
    }

    ZSTD_CCtx* context_;
};

std::string content_of(std::string_view text, std::uint64_t memory_bytes) {
    if (!text.starts_with(magic)) throw PifsFault{"it is no .pifs file: it does not begin with PIFS"};
    text.remove_prefix(magic.size());
    if (text.empty() || text.front() != pifs_version)
        throw PifsFault{
            fmt::format("graftal reads version {} of .pifs files, and this is another", pifs_version + 0)};
    text.remove_prefix(1);
    const unsigned long long size = ZSTD_getFrameContentSize(text.data(), text.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
        throw PifsFault{"its Zstandard frame is damaged"};
    if (size > memory_bytes / 2)
        throw PifsFault{fmt::format("its content takes {} MiB, more than is allowed", size >> 20)};
    if (ZSTD_findFrameCompressedSize(text.data(), text.size()) != text.size())
        throw PifsFault{"it is cut off, or has more than one Zstandard frame"};
    std::string content(size, '\0');
    const std::size_t got = ZSTD_decompress(content.data(), content.size(), text.data(), text.size());
    if (ZSTD_isError(got)) throw PifsFault{fmt::format("it is damaged: {}", ZSTD_getErrorName(got))};
    if (got != size) throw PifsFault{"it is damaged: its content is shorter than it says"};
    return content;
}

/// Takes bytes from the front of a content.
class PifsReader {
  public:
    explicit PifsReader(std::string_view content) : left_(content) {}

    std::string_view take(std::size_t count) {
        if (count > left_.size()) throw PifsFault{"it is damaged: its content ends too early"};
        const std::string_view taken = left_.substr(0, count);
        left_.remove_prefix(count);
        return taken;
    }
    unsigned byte() { return static_cast<unsigned char>(take(1).front()); }
    int word() {
        const unsigned low = byte();
        return static_cast<int>(low | byte() << 8);
    }
    bool bit() {
        if (bits_ == 1) bits_ = 0x100 | byte();
        const bool bit = bits_ & 1;
        bits_ >>= 1;
        return bit;
    }
    void expect_end_of_bits() const {
        if (!std::has_single_bit(bits_)) throw PifsFault{"it is damaged: bits are left over"};
    }
    bool at_end() const { return left_.empty(); }

  private:
    std::string_view left_;
    unsigned bits_ = 1; ///< those not yet taken, below a 1
};

BlockPicture read_head(PifsReader& reader, std::uint64_t memory_bytes) {
    BlockPicture picture;
    const unsigned kind = reader.byte(), bits = reader.byte();
    picture.width = reader.word();
    picture.height = reader.word();
    picture.colour = kind & 1;
    picture.alpha = kind & 2;
    if (kind > 3 || bits > most_pool_bits || picture.width < 1 || picture.height < 1 ||
        std::max(picture.width, picture.height) > most_picture_side)
        throw PifsFault{"it is damaged: its head is wrong"};
    const auto pixels =
        static_cast<std::uint64_t>(picture.width) * static_cast<std::uint64_t>(picture.height);
    if (pixels * bytes_a_pixel > memory_bytes)
        throw PifsFault{fmt::format("its picture of {}x{} pixels takes more memory than is allowed",
                                    picture.width, picture.height)};
    for (std::size_t i = 0; i < picture.plane_count(); ++i)
        picture.planes.push_back({picture.grid_of(i), static_cast<int>(bits), {}});
    return picture;
}

void read_map(unsigned code, BlockMap& block) {
    if (code == 0) return;
    block.isometry = static_cast<int>((code - 1) % mirror_code);
    block.slope = static_cast<int>((code - 1) / slope_code) + 1;
    if (block.slope > largest_slope) throw PifsFault{"it is damaged: a slope is too steep"};
    if ((code - 1) & mirror_code) block.slope = -block.slope;
}

void read_addresses(PifsReader& reader, BlockPicture& picture) {
    for (const int shift : {0, 8})
        for (CodedPlane& plane : picture.planes)
            for (BlockMap& block : plane.blocks)
                if (block.slope != 0) block.domain |= reader.byte() << shift;
    for (const CodedPlane& plane : picture.planes)
        for (int side = least_side; side <= largest_side; side *= 2) {
            const std::uint32_t domains = DomainPool(plane.grid, side, plane.pool_bits).count();
            for (const BlockMap& block : plane.blocks)
                if (block.side == side && block.slope != 0 && block.domain >= domains)
                    throw PifsFault{"it is damaged: a block names a domain that there is not"};
        }
}

BlockPicture read_content(std::string_view content, std::uint64_t memory_bytes) {
    PifsReader reader(content);
    BlockPicture picture = read_head(reader, memory_bytes);
    for (CodedPlane& plane : picture.planes)
        walk_partition(
            plane.grid, [&](int, int, int) { return reader.bit(); },
            [&](int x, int y, int side) {
                plane.blocks.push_back({x, y, side});
            });
    reader.expect_end_of_bits();
    for (CodedPlane& plane : picture.planes)
        for (BlockMap& block : plane.blocks)
            read_map(reader.byte(), block);
    for (CodedPlane& plane : picture.planes) {
        LevelGuess guess(plane.grid);
        for (BlockMap& block : plane.blocks) {
            const unsigned steps = static_cast<unsigned>(guess.guess(block)) + reader.byte();
            block.level = LevelGuess::level(static_cast<int>(steps % level_count), block.slope != 0);
            guess.put(block);
        }
    }
    read_addresses(reader, picture);
    if (!reader.at_end()) throw PifsFault{"it is damaged: its content is too long"};
    return picture;
}

/// Whether squares are divided, as bits.
std::string divisions_of(const BlockPicture& picture) {
    std::string bytes;
    unsigned bit = 8;
    for (const CodedPlane& plane : picture.planes) {
        std::size_t next = 0;
        walk_partition(
            plane.grid,
            [&](int, int, int side) {
                const bool divided = plane.blocks[next].side < side;
                if (bit == 8) {
                    bytes += '\0';
                    bit = 0;
                }
                if (divided) bytes.back() = static_cast<char>(bytes.back() | 1 << bit);
                ++bit;
                return divided;
            },
            [&](int, int, int) { ++next; });
    }
    return bytes;
}

} // namespace

std::string pifs_around(std::span<const std::string> parts) {
    std::size_t size = 0;
    for (const std::string& part : parts)
        size += part.size();
    std::string text(magic);
    text += pifs_version;
    FrameWriter frame(size);
    for (const std::string& part : parts)
        frame.add(part, &part == &parts.back(), text);
    return text;
}

std::string pifs_text(const BlockPicture& picture) {
    const int pool_bits = picture.planes.front().pool_bits;
    std::string head = {static_cast<char>((picture.colour ? 1 : 0) + (picture.alpha ? 2 : 0)),
                        static_cast<char>(pool_bits)};
    for (const int side : {picture.width, picture.height}) {
        head += static_cast<char>(side);
        head += static_cast<char>(side >> 8);
    }
    std::string maps, levels, low, high;
    for (const CodedPlane& plane : picture.planes) {
        LevelGuess guess(plane.grid);
        for (const BlockMap& block : plane.blocks) {
            const bool sloped = block.slope != 0;
            const unsigned code = static_cast<unsigned>(block.isometry) +
                                  (block.slope < 0 ? mirror_code : 0) +
                                  slope_code * (static_cast<unsigned>(std::abs(block.slope)) - 1);
            maps += static_cast<char>(sloped ? code + 1 : 0);
            levels += static_cast<char>(LevelGuess::steps(block.level, sloped) - guess.guess(block));
            guess.put(block);
            if (!sloped) continue;
            low += static_cast<char>(block.domain);
            high += static_cast<char>(block.domain >> 8);
        }
    }
    return pifs_around(std::vector{head, divisions_of(picture), maps, levels, low, high});
}

std::optional<BlockPicture> read_pifs(std::string_view text, std::uint64_t memory_bytes, std::string& fault) {
    try {
        return read_content(content_of(text, memory_bytes), memory_bytes);
    } catch (const PifsFault& found) {
        fault = found.text;
        return std::nullopt;
    }
}

} // namespace graftal
