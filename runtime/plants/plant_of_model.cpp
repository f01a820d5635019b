#include "runtime/plants/plant_of_model.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "compiler/session/stages.h"
#include "runtime/render/native_engine.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

/// Whether the graph ends by itself or by its steps: then no part need be left out for its size.
bool ends(const AnalysedModel& model, const StageOptions& stages) {
    return !model.components.unending[model.graph.root] || levels_of(model, stages.lower.steps).has_value();
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
    std::string problem;
    std::optional<PlantLight> light =
        light_on_plant(plant, traced, sky, asked, WorkerThreads(options.threads), session.control(), problem);
    if (!light)
        compilation.diagnostics.error(span, problem)
            .with_hint("allow more with --work, and give the model a 'sky' or a 'sun' above the horizon");
    else if (light->lit_organs > 0 && light->samples < asked.most_samples)
        compilation.diagnostics
            .warning(span,
                     fmt::format("within {} seconds of work each organ has {} samples of its light, not {}",
                                 asked.work_seconds, light->samples, asked.most_samples))
            .with_hint("allow more with --work");
    return light;
}

} // namespace

std::shared_ptr<const Plant> plant_of_model(Session& session, StageOptions stages,
                                            std::string_view else_error, Compilation& compilation) {
    stages.lower.in_place = LowerOptions::InPlace::plant;
    stages.lower.may_be_orbit = true;
    const std::shared_ptr<const LoweredModel> lowered = session.lowered(stages, compilation);
    if (!lowered || !compilation.status.ok() || compilation.diagnostics.has_errors()) return nullptr;
    if (!lowered->notes.plant) compilation.diagnostics.error(Span(), std::string(else_error));
    return lowered->notes.plant;
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
