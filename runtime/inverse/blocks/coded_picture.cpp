#include "runtime/inverse/blocks/coded_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/small_letters.h"
#include "runtime/inverse/blocks/decode.h"
#include "runtime/inverse/blocks/pifs_file.h"
#include "runtime/system/file.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

struct LevelError {
    double rms = 0, most = 0;
};

/// Distances of a plane's pixels from those of another, which may have a margin.
LevelError error_of(const LevelPlane& plane, const LevelPlane& other) {
    double sum = 0;
    LevelError error;
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x) {
            const double away = std::abs(double{plane.at(x, y)} - other.at(x, y));
            error.most = std::max(error.most, away);
            sum += away * away;
        }
    error.rms = std::sqrt(sum / static_cast<double>(plane.levels.size()));
    return error;
}

/// Runs a task; false where it was cancelled, or took too much work.
template<typename Task>
bool within_work(const BlockTask& limits, Compilation& compilation, const Task& task) {
    try {
        task();
        return true;
    } catch (const Cancelled&) {
    } catch (const OutOfWork& fault) {
        compilation.diagnostics
            .error({}, fmt::format("{} would take more work than {} seconds of one processor", fault.stage(),
                                   shortest(limits.seconds)))
            .with_hint("allow more with --work, or take a smaller picture");
    }
    return false;
}

std::function<void(double)> telling(const BlockTask& task, const char* stage) {
    if (!task.on_progress) return {};
    return [&task, stage](double share) { task.on_progress(stage, share); };
}

/// W of the plane itself, against the plane. The largest distance is that of both with the margin, on which W
/// works: the collage theorem asks for it.
LevelError collage_error(const LevelPlane& plane, const CodedPlane& coded, const Workers& workers,
                         const CancelFlag& cancel) {
    const PlaneIteration iteration(coded, plane.width, plane.height, plane.width, plane.height);
    LevelPlane to = iteration.grey();
    const LevelPlane from = with_margin(plane, to.width, to.height);
    const float most = iteration.apply(from, to, workers, cancel);
    return {error_of(plane, to).rms, most};
}

void measure(const LevelPlane& luma, const BlockPicture& picture, const Workers& workers,
             const CancelFlag& cancel, CodedPicture& coded) {
    for (const CodedPlane& plane : picture.planes)
        for (const BlockMap& block : plane.blocks) {
            std::size_t depth = 0;
            while (least_side << depth < block.side)
                ++depth;
            ++coded.blocks[depth];
            coded.flat_blocks += block.slope == 0;
        }
    const LevelError collage = collage_error(luma, picture.planes.front(), workers, cancel);
    BlockPicture grey{picture.width, picture.height, false, false, {picture.planes.front()}};
    const PicturePlanes decoded =
        decode_blocks(grey, picture.width, picture.height, workers, {cancel, {}, nullptr}, {});
    const LevelError error = error_of(luma, decoded.planes.front());
    coded.width = picture.width;
    coded.height = picture.height;
    coded.planes = picture.planes.size();
    coded.pool_bits = picture.planes.front().pool_bits;
    coded.contraction = contraction_of(picture);
    coded.collage_rms = collage.rms;
    coded.collage_most = collage.most;
    coded.bound = collage.most / (1 - contraction_of(grey));
    coded.rms = error.rms;
    coded.most = error.most;
}

} // namespace

double CodedPicture::psnr() const {
    return rms > 0 ? 20 * std::log10(255 / rms) : std::numeric_limits<double>::infinity();
}

double CodedPicture::bits_a_pixel() const {
    return 8 * static_cast<double>(text.size()) / (static_cast<double>(width) * height);
}

std::optional<CodedPicture> code_picture(const std::string& path, double tolerance, const BlockTask& task,
                                         const CancelFlag& cancel, Compilation& compilation) {
    PlanesSink sink(task.memory_bytes);
    const Status status = read_rows(path, sink);
    if (!sink.refusal().empty()) {
        compilation.diagnostics.error({}, fmt::format("'{}' {}", path, sink.refusal()))
            .with_hint("allow more with --memory, or take a smaller picture");
        return std::nullopt;
    }
    compilation.status = status;
    if (!status.ok()) return std::nullopt;
    const PicturePlanes planes = sink.finish();
    const WorkerThreads workers(task.threads);
    CodedPicture coded;
    const bool done = within_work(task, compilation, [&] {
        BlocksFound found =
            find_blocks(planes, {tolerance, task.seconds}, workers, cancel, telling(task, "matching blocks"));
        coded.seconds = found.seconds;
        coded.text = pifs_text(found.picture);
        measure(planes.planes.front(), found.picture, workers, cancel, coded);
    });
    return done ? std::optional(std::move(coded)) : std::nullopt;
}

std::optional<Image> draw_pifs(const std::string& path, std::optional<ImageSize> size, const BlockTask& task,
                               const CancelFlag& cancel, Compilation& compilation) {
    std::string text, fault;
    compilation.status = read_text(path, text);
    if (!compilation.status.ok()) return std::nullopt;
    const std::optional<BlockPicture> picture = read_pifs(text, task.memory_bytes, fault);
    if (!picture) {
        compilation.diagnostics.error({}, fmt::format("cannot read '{}': {}", path, fault))
            .with_hint("make it again: graftal fit --blocks PICTURE -o FILE.pifs");
        return std::nullopt;
    }
    const int width = size ? size->width : picture->width, height = size ? size->height : picture->height;
    if (decoding_bytes(*picture, width, height) > task.memory_bytes) {
        compilation.diagnostics
            .error({}, fmt::format("to decode '{}' to {}x{} pixels takes {} MiB, and {} are allowed", path,
                                   width, height, (decoding_bytes(*picture, width, height) >> 20) + 1,
                                   task.memory_bytes >> 20))
            .with_hint("allow more with --memory, or decode it smaller with --size");
        return std::nullopt;
    }
    std::optional<Image> image;
    within_work(task, compilation, [&] {
        StageWork work(task.seconds);
        image = image_of(decode_blocks(*picture, width, height, WorkerThreads(task.threads),
                                       {cancel, {}, &work}, telling(task, "iterating")));
    });
    return image;
}

bool is_pifs_name(const std::string& path) {
    return in_small_letters(path).ends_with(".pifs");
}

} // namespace graftal
