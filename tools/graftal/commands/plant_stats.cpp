#include "tools/graftal/commands/plant_stats.h"

#include <optional>
#include <string>

#include "runtime/plants/measures_report.h"
#include "runtime/plants/plant_of_model.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

PlantLightOptions light_options(const Options& options) {
    PlantLightOptions light;
    light.work_seconds = options.render.work_seconds.value_or(inspecting_seconds);
    light.samples = options.render.samples;
    return light;
}

Control watched(const Interruption& interruption, ProgressBar& bar) {
    return {interruption.flag(), [&bar](const Progress& progress) {
                const std::string stage(progress.stage);
                if (progress.total > 0)
                    bar.show(stage, static_cast<double>(progress.done) / static_cast<double>(progress.total));
                else
                    bar.show(stage + "...");
            }};
}

int run_plant_stats(const Options& options) {
    Compilation compilation;
    const std::string& path = options.operands.front();
    CommandSession session(options, path, Keep::for_views);
    ProgressBar bar(options.irradiance && !options.quiet);
    const Interruption interruption;
    session.set_control(watched(interruption, bar));
    RenderOptions render = options.render;
    render.compile = inspecting(options, true);
    const auto [plant, totals] =
        plant_or_totals_of_model(session, render.compile, options.irradiance, compilation);
    std::optional<PlantMeasures> measures;
    if (plant)
        measures = measures_of_model(session, render.compile, *plant, options.ground_area, compilation);
    std::optional<PlantLight> light;
    if (measures && options.irradiance)
        light = light_of_model(session, render, *plant, light_options(options), compilation);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (status != exit_done) return status;
    if (totals)
        return print_output(options.json ? totals_json(path, *totals, options.ground_area)
                                         : totals_text(path, *totals, options.ground_area));
    if (!measures) return status;
    const PlantLight* const lit = light ? &*light : nullptr;
    return print_output(options.json ? measures_json(path, *measures, lit)
                                     : measures_text(path, *measures, lit));
}

} // namespace graftal
