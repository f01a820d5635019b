#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/inverse/blocks/coded_picture.h"
#include "runtime/inverse/blocks/encode.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/fit_answer.h"
#include "tools/graftal/progress_bar.h"

namespace graftal {

namespace {

using Json = nlohmann::ordered_json;

BlockTask block_task(const Options& options, ProgressBar& bar) {
    BlockTask task;
    task.memory_bytes = options.render.compile.detail.memory_bytes;
    task.seconds = options.render.work_seconds.value_or(task.seconds);
    task.threads = options.render.threads;
    task.on_progress = [&bar](const char* stage, double share) { bar.show(stage, share); };
    return task;
}

Json coded_json(const Options& options, const CodedPicture& coded) {
    Json blocks;
    for (std::size_t depth = range_sides; depth-- > 0;)
        blocks[std::to_string(least_side << depth)] = coded.blocks[depth];
    return {{"picture", options.points.target},
            {"file", options.render.output},
            {"width", coded.width},
            {"height", coded.height},
            {"planes", coded.planes},
            {"bytes", coded.text.size()},
            {"bits_a_pixel", coded.bits_a_pixel()},
            {"rms", coded.rms},
            {"largest_error", coded.most},
            {"psnr_db", coded.rms > 0 ? Json(coded.psnr()) : Json(nullptr)},
            {"collage_rms", coded.collage_rms},
            {"collage_largest", coded.collage_most},
            {"contraction", coded.contraction},
            {"bound", coded.bound},
            {"blocks", std::move(blocks)},
            {"flat_blocks", coded.flat_blocks},
            {"pool_bits", coded.pool_bits},
            {"work_seconds", coded.seconds}};
}

std::string coded_text(const Options& options, const CodedPicture& coded) {
    std::string sides;
    for (std::size_t depth = range_sides; depth-- > 0;)
        sides += fmt::format("{} of {} pixels, ", coded.blocks[depth], least_side << depth);
    return fmt::format(
        "{}: {} bytes for {}x{} pixels, {:.3f} bits a pixel\n"
        "error          {:.2f} levels of 255 in luma, root mean square; PSNR {:.2f} dB\n"
        "collage        {:.2f} levels, at most {:.1f}; every slope is at most {:.3f}, so the error "
        "is at most {:.0f}, and is {:.1f}\n"
        "blocks         {}{} of them flat; pools of at most {} domains\n"
        "work           {:.1f} s, counted\n",
        options.render.output, coded.text.size(), coded.width, coded.height, coded.bits_a_pixel(), coded.rms,
        coded.psnr(), coded.collage_rms, coded.collage_most, coded.contraction, coded.bound, coded.most,
        sides, coded.flat_blocks, 1u << coded.pool_bits, coded.seconds);
}

} // namespace

int run_fit_blocks(const Options& options) {
    ProgressBar bar(!options.quiet);
    Compilation compilation;
    const Interruption interruption;
    const std::optional<CodedPicture> coded =
        code_picture(options.points.target, options.fit.tolerance.value_or(BlockCoding().tolerance),
                     block_task(options, bar), interruption.flag(), compilation);
    bar.clear();
    return answer_fit(options, coded, coded_json, coded_text, interruption, compilation);
}

int run_render_pifs(const Options& options) {
    ProgressBar bar(!options.quiet);
    Compilation compilation;
    const Interruption interruption;
    const ViewOptions& view = options.render.compile.view;
    const std::optional<Image> image =
        draw_pifs(options.operands.front(), view.shaped ? std::nullopt : std::optional(view.size),
                  block_task(options, bar), interruption.flag(), compilation);
    if (image)
        compilation.status =
            write_image(options.render.output, *image, options.render.format, options.render.metadata);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (status == exit_done && image && !options.quiet)
        say(fmt::format("{}: {}x{} pixels\n", options.render.output, image->width, image->height));
    return status;
}

} // namespace graftal
