#include "runtime/plants/plant_of_model.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/lsys/as_drawn.h"
#include "compiler/session/stages.h"
#include "compiler/support/counter_random.h"
#include "runtime/render/native_engine.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

/// Whether the graph ends by itself or by its steps: then no part need be left out for its size.
bool ends(const AnalysedModel& model, const StageOptions& stages) {
    return !model.components.unending[model.graph.root] || levels_of(model, stages.lower.steps).has_value();
}

/// Warns of organs that lie exactly where others of their kind do. Parts that share what chance chose differ
/// by where they stand, unless chance alone says that too.
void warn_of_coinciding(const Plant& plant, Span span, Diagnostics& diagnostics) {
    constexpr std::uint64_t few = 100; // one in so many may happen to
    double reach = 0;
    for (const PlantModule& module : plant.modules)
        reach = std::max(reach, largest_entry(module.start));
    const double grid = 1e-9 * reach;
    std::vector<std::uint64_t> places;
    for (const PlantModule& module : plant.modules) {
        if (!(module.area > 0) || module.organ == Organ::none) continue;
        auto place = static_cast<std::uint64_t>(module.organ);
        const auto add = [&](Vec3 vector, double unit) {
            for (int i = 0; i < 3; ++i) {
                const double number = unit > 0 ? std::round(vector[i] / unit) + 0.0 : 0; // -0 is 0
                place = CounterRandom(place)(std::bit_cast<std::uint64_t>(number));
            }
        };
        add(module.start, grid);
        add(module.heading, 1e-6);
        add(module.up, 1e-6);
        places.push_back(place);
    }
    std::ranges::sort(places);
    const auto coinciding =
        static_cast<std::size_t>(places.end() - std::unique(places.begin(), places.end()));
    if (!(few * coinciding > places.size())) return;
    diagnostics
        .warning(span,
                 fmt::format("{} of {} organs lie exactly in others, and so their light is wrong: parts "
                             "share the places that chance chose",
                             coinciding, places.size()))
        .with_hint("give '--exact', by which chance chooses for each part");
}

PlantOrTotals told_of_model(Session& session, StageOptions& stages, LowerOptions::InPlace wanted,
                            std::string_view else_error, Compilation& compilation) {
    stages.lower.in_place = wanted;
    stages.lower.may_be_orbit = true;
    const std::shared_ptr<const LoweredModel> lowered = session.lowered(stages, compilation);
    if (!lowered || !compilation.status.ok() || compilation.diagnostics.has_errors()) return {};
    if (!lowered->notes.plant && !lowered->notes.totals)
        compilation.diagnostics.error(Span(), std::string(else_error));
    return {lowered->notes.plant, lowered->notes.totals};
}

std::optional<PlantLight> traced_light(PictureSession& session, const RenderOptions& options,
                                       const Plant& plant, const PlantLightOptions& asked,
                                       Compilation& compilation) {
    RenderOptions render = options;
    render.compile.draws = true;
    render.compile.lower.in_place = LowerOptions::InPlace::nothing;
    render.compile.lower.may_leave_out_colours = false;
    const std::shared_ptr<const AnalysedModel> model = session.analysed(render.compile, compilation);
    if (!model) return std::nullopt;
    if (ends(*model, render.compile)) {
        render.compile.detail.error_px = 0;
        render.compile.detail.error_world.reset();
    }
    PreparedView prepared;
    if (!prepare_view(session, render, prepared, compilation)) return std::nullopt;
    const CancelFlag& cancel = session.control().cancel;
    const Graph& graph = model->graph;
    const TraceModel traced(prepared.prepared, prepared.viewed->view, prepared.detail, prepared.textures,
                            nullptr, cancel);
    const PlantSky sky = sky_of_plant(prepared.viewed->view, graph.settings);
    const Span span = graph.objects[graph.root].span;
    const int wanted = asked.samples.value_or(PlantLightOptions::usual_samples);
    std::string problem;
    std::optional<PlantLight> light =
        light_on_plant(plant, traced, sky, asked, WorkerThreads(options.threads), session.control(), problem);
    if (!light)
        compilation.diagnostics.error(span, problem)
            .with_hint("allow more with --work, and give the model a 'sky' or a 'sun' above the horizon");
    else if (light->lit_organs > 0 && light->samples < wanted)
        compilation.diagnostics
            .warning(span,
                     fmt::format("within {} seconds of work each organ has {} samples of its light, not {}",
                                 asked.work_seconds, light->samples, wanted))
            .with_hint("allow more with --work");
    if (model->derivation && model->derivation->variants > 1)
        warn_of_coinciding(plant, span, compilation.diagnostics);
    return light;
}

} // namespace

std::shared_ptr<const Plant> plant_of_model(Session& session, StageOptions stages,
                                            std::string_view else_error, Compilation& compilation) {
    return told_of_model(session, stages, LowerOptions::InPlace::plant, else_error, compilation).plant;
}

PlantOrTotals plant_or_totals_of_model(Session& session, StageOptions stages, bool needs_rows,
                                       Compilation& compilation) {
    constexpr std::string_view else_error = "only L-systems have a plant that can be measured";
    Compilation of_rows = compilation, of_totals = compilation;
    const auto most_rows = std::min(most_told_modules, stages.lower.max_modules);
    PlantOrTotals told = told_of_model(session, stages, LowerOptions::InPlace::plant, else_error, of_rows);
    if (!needs_rows && !told.plant && of_rows.diagnostics.has_errors())
        told = told_of_model(session, stages, LowerOptions::InPlace::totals, else_error, of_totals);
    const bool too_many = told.totals && told.totals->all.modules > most_rows;
    if (!too_many) told.totals = nullptr;
    compilation = std::move(too_many ? of_totals : of_rows);
    return told;
}

std::optional<PlantMeasures> measures_of_model(const Session& session, const StageOptions& stages,
                                               const Plant& plant, std::optional<double> ground_area,
                                               Compilation& compilation) {
    StageWork work(stage_work_limit(stages));
    Control control = session.control();
    control.work = &work;
    try {
        return measure_plant(plant, tree_of(plant), ground_area, control);
    } catch (const Cancelled&) {
        compilation.status = Status::failure("interrupted");
    } catch (const OutOfWork& fault) {
        compilation.diagnostics
            .error(Span(), fmt::format("to measure {} modules takes more than {} seconds of work",
                                       plant.modules.size(), fault.limit_seconds()))
            .with_hint("allow more with --work, or use fewer steps");
    }
    return std::nullopt;
}

std::optional<PlantLight> light_of_model(PictureSession& session, const RenderOptions& options,
                                         const Plant& plant, const PlantLightOptions& light,
                                         Compilation& compilation) {
    try {
        return traced_light(session, options, plant, light, compilation);
    } catch (const Cancelled&) {
        compilation.status = Status::failure("interrupted");
    }
    return std::nullopt;
}

} // namespace graftal
