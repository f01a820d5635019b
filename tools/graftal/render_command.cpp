#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "runtime/render/povray_engine.h"
#include "runtime/render/render.h"
#include "runtime/render/scene_files.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

int run_render(const Options& options) {
    ProgressBar bar(!options.quiet);
    RenderOptions render = options.render;
    render.on_progress = [&](const DrawProgress& progress) { bar.show(progress); };
    render.on_start = [&](double seconds) {
        // Besides what the compiler takes, of the same work.
        if (!(seconds > 0.5 * options.render.compile.detail.work_seconds)) return;
        bar.clear();
        say(fmt::format("graftal: POV-Ray will take about {} seconds of one processor; '--engine native' is "
                        "faster; a larger --error or a smaller --memory or --size means less work\n",
                        readable_seconds(seconds)));
    };

    Compilation compilation;
    bar.show("compiling...");
    CommandSession session(options, options.operands.front());
    const bool compiled = options.engine->compile(session, render.compile, compilation);
    const Interruption interruption; // from here on something may be half written
    session.set_control({interruption.flag(), {}});
    std::optional<DrawReport> report;
    if (compiled) report = options.engine->draw(session, render, compilation);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (report && !options.quiet) say(fmt::format("{}: {}\n", options.render.output, report->summary));
    return status;
}

int run_compile(const Options& options) {
    Compilation compilation;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const CompiledModel> model = session.compiled(options.render.compile, compilation);
    const Interruption interruption;
    if (model) {
        const bool include = options.render.output.ends_with(".inc");
        compilation.status = options.render.output == "-"
                                 ? print_scene(*model, include, compilation.diagnostics, interruption.flag())
                                 : write_scene(*model, options.render.output,
                                               {.include = include, .identifier = options.identifier},
                                               session.textures(), interruption.flag());
    }
    const int status = conclude(options, compilation, interruption.signal());
    if (status == exit_done && !options.quiet && options.render.output != "-")
        say(fmt::format("{}: {}\n", options.render.output, cut_text(model->cut)));
    return status;
}

} // namespace graftal
