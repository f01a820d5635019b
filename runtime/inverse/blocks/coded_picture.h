#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "compiler/session/session.h"
#include "runtime/image_files/image_files.h"
#include "runtime/inverse/blocks/encode.h"

namespace graftal {

/// A limit of a task, and what hears of it.
struct BlockTask {
    std::uint64_t memory_bytes = 2ull << 30;
    double seconds = 30; ///< of one processor, by counted work
    int threads = 0;     ///< 0: one a processor
    std::function<void(const char* stage, double share)> on_progress;
};

/// A picture as a .pifs file, and how near its attractor is. Errors are those of the luma, in levels of 255.
struct CodedPicture {
    std::string text; ///< of the file
    int width = 0, height = 0;
    std::size_t planes = 0;
    std::array<std::size_t, range_sides> blocks{}; ///< by side, the least first
    std::size_t flat_blocks = 0;
    int pool_bits = 0;
    double contraction = 0;                   ///< s
    double collage_rms = 0, collage_most = 0; ///< of the picture from W of it; the most in the margin, too
    double rms = 0, most = 0;                 ///< of the picture from the attractor
    double bound = 0;                         ///< of `most`, by the collage theorem
    double seconds = 0;                       ///< of counted work

    double psnr() const;
    double bits_a_pixel() const;
};

/// Codes a picture by blocks. Nothing comes back after errors in `compilation.diagnostics`, with a failed
/// `compilation.status`, or when the flag is raised. Larger pictures than the memory allows are refused
/// before they are read.
std::optional<CodedPicture> code_picture(const std::string& path, double tolerance, const BlockTask& task,
                                         const CancelFlag& cancel, Compilation& compilation);

/// The attractor of a .pifs file, in the size that is asked for, or in that of the picture that was coded.
/// Refusals and errors are those of code_picture().
std::optional<Image> draw_pifs(const std::string& path, std::optional<ImageSize> size, const BlockTask& task,
                               const CancelFlag& cancel, Compilation& compilation);

/// True for names that end in .pifs.
bool is_pifs_name(const std::string& path);

} // namespace graftal
