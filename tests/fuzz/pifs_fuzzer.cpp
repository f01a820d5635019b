// Contents of .pifs files, in a sound frame: any bytes give a picture or a message, and a picture is written
// as it was read, and decoded.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compiler/support/check.h"
#include "runtime/inverse/blocks/decode.h"
#include "runtime/inverse/blocks/pifs_file.h"

using namespace graftal;

namespace {

constexpr std::uint64_t memory_bytes = 4 << 20;

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string content(reinterpret_cast<const char*>(data), size);
    std::string fault;
    const std::optional<BlockPicture> read =
        read_pifs(pifs_around(std::vector{content}), memory_bytes, fault);
    GRAFTAL_CHECK(read || !fault.empty(), "pifs fuzzer: a picture or a message");
    if (!read) return 0;
    const std::optional<BlockPicture> again = read_pifs(pifs_text(*read), memory_bytes, fault);
    GRAFTAL_CHECK(again.has_value(), "pifs fuzzer: what is written is read");
    for (std::size_t i = 0; i < read->planes.size(); ++i)
        GRAFTAL_CHECK(again->planes[i].blocks == read->planes[i].blocks, "pifs fuzzer: the same blocks");
    const PicturePlanes drawn = decode_blocks(*read, 13, 9, SerialWorkers(), no_control(), {});
    for (const LevelPlane& plane : drawn.planes)
        for (const float level : plane.levels)
            GRAFTAL_CHECK(std::isfinite(level), "pifs fuzzer: levels are numbers");
    return 0;
}
