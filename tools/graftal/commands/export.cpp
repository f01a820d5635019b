#include <fmt/format.h>

#include "runtime/export/export_model.h"
#include "runtime/export/plant_files.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/plant_stats.h"
#include "tools/graftal/options/export.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

/// Says what was written. The exit status.
int tell(const Options& options, const Compilation& compilation, const Interruption& interruption,
         const std::optional<std::string>& written) {
    const int status = conclude(options, compilation, interruption.signal());
    if (written && status == exit_done && !options.quiet)
        say(fmt::format("{}: {}\n", options.render.output, *written));
    return status;
}

/// The modules of an L-system as data.
int run_plant(const Options& options, const PlantFormat& format) {
    Compilation compilation;
    CommandSession session(options, options.operands.front(), Keep::for_views);
    ProgressBar bar(options.irradiance && !options.quiet);
    const Interruption interruption;
    session.set_control(watched(interruption, bar));
    const PlantLightOptions light = light_options(options);
    RenderOptions render = options.render;
    render.compile = inspecting(options, true);
    const std::optional<std::string> written =
        export_plant(session, render, format, export_options(options).file,
                     options.irradiance ? &light : nullptr, compilation);
    bar.clear();
    return tell(options, compilation, interruption, written);
}

} // namespace

int run_export(const Options& options) {
    if (const PlantFormat* const format = find_plant_format(options.render.output))
        return run_plant(options, *format);
    ProgressBar bar(!options.quiet);
    bar.show("exporting...");
    Compilation compilation;
    CommandSession session(options, options.operands.front(), Keep::for_views);
    const Interruption interruption;
    ShownTime time(bar, "exporting", interruption.flag());
    session.set_control({time.flag(), {}});
    const std::optional<std::string> written = export_model(session, export_options(options), compilation);
    bar.clear();
    return tell(options, compilation, interruption, written);
}

} // namespace graftal
