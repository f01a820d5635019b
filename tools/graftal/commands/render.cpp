#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/detail/coarser.h"
#include "compiler/povray/cut/compile.h"
#include "runtime/inverse/blocks/coded_picture.h"
#include "runtime/render/povray_engine.h"
#include "runtime/render/render.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

/// The line that stands before a picture starts, or "".
std::string start_text(const Engine& engine, const RenderOptions& render, const DrawStart& start) {
    const std::string seconds = readable_seconds(start.seconds);
    if (engine.name == povray_engine.name) {
        // Besides what the compiler takes, of the same work.
        if (!(start.seconds > 0.5 * render.compile.detail.work_seconds)) return {};
        return fmt::format(
            "POV-Ray will take about {} seconds of one processor; '--engine {}' is faster; a larger "
            "--error or a smaller --memory or --size means less work",
            seconds, engines().front().name);
    }
    const bool best = render.compile.view.quality == Quality::best;
    if (!start.fewer.empty() && !best)
        return fmt::format(
            "{}, in about {} seconds of one processor; a smoother picture takes '--work {}' or "
            "'--quality best'",
            start.fewer, seconds, readable_seconds(1.2 * start.whole_seconds));
    constexpr double long_seconds = 20;
    return start.seconds > long_seconds ? fmt::format("about {} seconds of one processor", seconds) : "";
}

} // namespace

int run_render(const Options& options) {
    if (is_pifs_name(options.operands.front())) return run_render_pifs(options);
    if (options.watch) return run_watch(options);
    ProgressBar bar(!options.quiet);
    RenderOptions render = options.render;
    render.progressive = options.progressive.value_or(!render.tile && options.engine->progressive);
    render.on_progress = [&](const DrawProgress& progress) { bar.show(progress); };
    render.on_start = [&](const DrawStart& start) {
        if (options.quiet) return;
        const std::string text = start_text(*options.engine, options.render, start);
        if (text.empty()) return;
        bar.clear();
        say("graftal: " + text + "\n");
    };

    Compilation compilation;
    const Stopwatch watch;
    bar.show("compiling...");
    std::vector<std::string> uses;
    const HeardFiles files(disk_files(), [&](const std::string& path) { uses.push_back(path); });
    CommandSession session(options, options.operands.front(), Keep::nothing, files);
    const bool compiled = options.engine->compile(session, render.compile, compilation) &&
                          !refuse_own_file(options, uses, compilation);
    const Interruption interruption; // from here on something may be half written
    session.set_control({interruption.flag(), {}});
    std::optional<DrawReport> report;
    render.seconds_before = watch.seconds();
    if (compiled) report = options.engine->draw(session, render, compilation);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (report && !options.quiet) say(fmt::format("{}: {}\n", options.render.output, report->summary));
    return status;
}

namespace {

/// "; 2 pictures beside it: fern_P_1.png, fern_P_2.png", or "".
std::string beside_text(const std::vector<std::string>& pictures) {
    constexpr std::size_t most_named = 3;
    if (pictures.empty()) return {};
    const std::size_t named = std::min(pictures.size(), most_named);
    return fmt::format(
        "; {} picture{} beside it: {}{}", pictures.size(), pictures.size() == 1 ? "" : "s",
        fmt::join(pictures.begin(), pictures.begin() + static_cast<std::ptrdiff_t>(named), ", "),
        named < pictures.size() ? ", ..." : "");
}

} // namespace

int run_compile(const Options& options) {
    Compilation compilation;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const CompiledModel> model =
        compile_scene(session, options.render.compile, compilation, options.render.cut);
    const Interruption interruption;
    std::vector<std::string> pictures;
    if (model) {
        const bool include = options.render.output.ends_with(".inc");
        compilation.status = options.render.output == "-"
                                 ? print_scene(*model, include, compilation.diagnostics, interruption.flag())
                                 : write_scene(*model, options.render.output,
                                               {.include = include, .identifier = options.identifier},
                                               session.textures(), interruption.flag(), &pictures);
    }
    const int status = conclude(options, compilation, interruption.signal());
    if (status == exit_done && !options.quiet && options.render.output != "-")
        say(fmt::format("{}: {}{}\n", options.render.output, cut_text(model->cut), beside_text(pictures)));
    return status;
}

} // namespace graftal
