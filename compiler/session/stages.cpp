#include "compiler/session/stages.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/analysis/model_range.h"
#include "compiler/graph/verify.h"
#include "compiler/languages/lower.h"
#include "compiler/scene/sight.h"
#include "compiler/session/analyse_shapes.h"
#include "compiler/session/frame_model.h"
#include "compiler/session/shared_framing.h"
#include "compiler/session/stage_clock.h"
#include "compiler/support/check.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// Runs the passes. The path that an address led to follows the objects that it leads through.
Graph optimise(Graph graph, std::optional<GraphPath>& at, const PipelineOptions& options,
               std::vector<StageTime>& times, const Control& control) {
    WorkMeter meter(control, "passes", 1);
    meter.charge(work_of_graph(graph.objects.size(), instance_count(graph)));
    std::vector<PassTime> pass_times;
    BoundedGraph before{std::move(graph), {}};
    if (at) {
        before.path = at->steps;
        before.path.insert(before.path.end(), at->cycle.begin(), at->cycle.end());
    }
    BoundedGraph after = run_passes(model_passes(), std::move(before), options, &pass_times, &meter);
    if (at) {
        const auto end = after.path.begin() + static_cast<std::ptrdiff_t>(at->steps.size());
        at = GraphPath{{after.path.begin(), end}, {end, after.path.end()}};
    }
    for (PassTime& time : pass_times)
        times.push_back({std::move(time.name), time.seconds});
    return std::move(after.graph);
}

std::string digits(double value, int count) {
    std::string out;
    append_number(out, value, count);
    return out;
}

/// Where the model says the step of a cycle; a generated instance stands for its object.
Span span_of(const Graph& graph, const GraphStep& step) {
    const Object& object = graph.objects[step.object];
    const Span span = object.instances[step.instance].span;
    return span.known() ? span : object.span;
}

/// The growth of sizes by one way around, in words.
std::string growth_around(const Contraction& contraction) {
    const auto instances = static_cast<double>(contraction.worst_cycle.size());
    const double factor = std::pow(contraction.rate(), instances);
    if (!std::isfinite(factor)) return "it grows without bounds";
    const std::string times = digits(factor, 6);
    return times == "1" ? "it keeps its size" : fmt::format("it grows {} times", times);
}

void report_refuted(const Graph& graph, const Contraction& contraction, Diagnostics& diagnostics) {
    const std::vector<GraphStep>& cycle = contraction.worst_cycle;
    diagnostics
        .error(span_of(graph, cycle.front()),
               fmt::format("the cycle {} does not contract: each time around, {}",
                           describe_cycle(graph, cycle), growth_around(contraction)))
        .with_hint("an object may contain itself only if every way around the cycle makes it smaller: scale "
                   "down an instance of the cycle");
}

void report_undecided(const Graph& graph, const Contraction& contraction, Diagnostics& diagnostics) {
    const std::vector<GraphStep>& cycle = contraction.worst_cycle;
    const Span span = cycle.empty() ? graph.objects[graph.root].span : span_of(graph, cycle.front());
    Diagnostic& error = diagnostics.error(
        span,
        fmt::format("cannot prove that every cycle contracts: the factor per instance lies between {} and {}",
                    digits(contraction.lower, 12), digits(contraction.upper, 12)));
    error.with_hint("give the instances that expand a slightly smaller scale");
    if (!cycle.empty())
        error.with_note(span,
                        fmt::format("the cycle that contracts least is {}", describe_cycle(graph, cycle)));
}

View view_of(const AnalysedModel& model, std::optional<unsigned> steps, const ViewOptions& options,
             bool part) {
    if (!options.framing) return frame_model(model, steps, options);
    if (!part) return options.framing->view(model, options);
    // A part that is looked at by itself (--at) is framed for its own frame, which the models do not know.
    SharedFraming own;
    own.include(model, steps);
    own.settle(options.camera, options.size, options.framing->turning());
    return own.view(model, options);
}

/// A function that frames an object as if it were the model. The model's camera is meant for its root.
FrameObject framing_of(const AnalysedModel& model, std::optional<unsigned> steps,
                       const ViewOptions& options) {
    return [&model, steps, &options](ObjectId object, unsigned used_levels) {
        if (object == model.graph.root) return view_of(model, steps, options, false);
        AnalysedModel part = model;
        part.graph.root = object;
        part.graph.settings.camera.reset();
        return view_of(part, steps ? std::optional(*steps - used_levels) : steps, options, true);
    };
}

/// Gives the model a new root at the place that the zoom asks for.
std::optional<ViewedModel> zoom_in(const AnalysedModel& model, std::optional<unsigned> steps,
                                   const ViewOptions& options, Diagnostics& diagnostics,
                                   const Control& control) {
    std::optional<Vec3> look_at = options.zoom.eye ? std::nullopt : options.camera.look_at;
    if (!look_at && model.graph.settings.camera) look_at = model.graph.settings.camera->look_at;
    std::optional<Rerooted> rerooted =
        reroot({model.graph, model.components, model.bounds, steps, model.at}, options.zoom,
               framing_of(model, steps, options), look_at, diagnostics, control);
    if (!rerooted) return std::nullopt;
    auto zoomed = std::make_shared<AnalysedModel>();
    zoomed->path = model.path;
    zoomed->written = model.written;
    zoomed->graph = std::move(rerooted->graph);
    zoomed->components = std::move(rerooted->components);
    zoomed->contraction = model.contraction;
    zoomed->bounds = std::move(rerooted->bounds);
    zoomed->derivation = model.derivation;
    zoomed->work_seconds = model.work_seconds; // without the zoom's, which its depth decides
    zoomed->clouds = model.clouds;
    return ViewedModel{std::move(zoomed), rerooted->steps, std::move(rerooted->view), rerooted->zoom,
                       std::make_shared<const NearWays>(std::move(rerooted->ways))};
}

} // namespace

double stage_work_limit(const StageOptions& options) {
    constexpr double least_seconds = 2;
    return std::max(options.detail.work_seconds, least_seconds);
}

StageWork stage_work(const StageOptions& options, double spent_seconds) {
    constexpr double share_of_picture = 0.6; // to prepare a graph takes as long as all stages before
    const double limit = stage_work_limit(options);
    const bool keeps = options.draws && std::isfinite(limit);
    return StageWork(limit, spent_seconds, keeps ? share_of_picture * limit : 0);
}

std::optional<Source> read_source(const std::string& path, const std::string& root, const Files& files,
                                  const Translator& translator, Diagnostics& diagnostics, Status& status) {
    const std::string file = translator.model_path(path).file;
    if (file != "-" && !root.empty() && !files.lies_in(file, root)) {
        diagnostics.error(Span(), fmt::format("'{}' leads out of the root folder '{}'", file, root));
        return std::nullopt;
    }
    Source source{path, {}};
    status = files.read(file, source.text);
    if (!status.ok()) return std::nullopt;
    return source;
}

std::optional<LoweredModel> lower_source(const Source& source, const LowerOptions& options,
                                         const LowerHelp& help, SourceMap& sources,
                                         Diagnostics& diagnostics) {
    LoweredText lowered = lower_text(source.path, source.text, options, sources, diagnostics, help);
    LoweredModel model{source.path, std::move(lowered.graph), std::move(lowered.notes)};
    if (help.control.work) model.work_seconds = help.control.work->seconds();
    const bool draws_nothing =
        model.notes.derivation && options.may_draw_nothing && !diagnostics.has_errors();
    const LowerNotes& notes = model.notes;
    const bool has_other = notes.orbit || notes.word || notes.plant || notes.totals;
    if (!model.graph && !has_other && !draws_nothing) return std::nullopt;
    return model;
}

bool check_pass(const std::string& name, Diagnostics& diagnostics) {
    std::vector<std::string> names;
    for (const Pass& pass : model_passes())
        names.emplace_back(pass.name);
    if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return true;
    diagnostics.error({}, fmt::format("there is no pass '{}'", name))
        .with_hint(fmt::format("the passes are {}", fmt::join(names, ", ")));
    return false;
}

std::optional<AnalysedModel> analyse(LoweredModel lowered, const std::optional<Address>& at,
                                     const PipelineOptions& options, Diagnostics& diagnostics,
                                     std::vector<StageTime>& times, const Control& control) {
    AnalysedModel model;
    model.path = std::move(lowered.path);
    model.derivation = std::move(lowered.notes.derivation);
    if (!lowered.graph) return model;
    model.written = {lowered.graph->objects.size(), edge_count(*lowered.graph)};
    // Names are those of the text only here: equal objects are merged next.
    if (at) {
        model.at = find_path(*lowered.graph, *at, diagnostics, control);
        if (!model.at) return std::nullopt;
    }
    model.graph = optimise(std::move(*lowered.graph), model.at, options, times, control);
    model.components = StageClock(times).run("components", [&] { return strong_components(model.graph); });
    analyse_shapes(model, times, control);
    if (converges(model.contraction) &&
        !check_range(model.graph, model.components, model.bounds, diagnostics))
        return std::nullopt;
    if (control.work) model.work_seconds = control.work->seconds();
    return model;
}

bool refuse_divergent(const AnalysedModel& model, Diagnostics& diagnostics) {
    if (model.graph.objects.empty() || converges(model.contraction)) return false;
    if (model.contraction.verdict == Verdict::refuted)
        report_refuted(model.graph, model.contraction, diagnostics);
    else
        report_undecided(model.graph, model.contraction, diagnostics);
    return true;
}

std::optional<unsigned> levels_of(const AnalysedModel& model, std::optional<unsigned> asked) {
    return asked && !model.derivation ? asked : model.graph.settings.steps;
}

namespace {

/// Where --camera asks for a lens and the picture has none.
void warn_of_no_lens(const ViewedModel& viewed, const ViewOptions& options, Diagnostics& diagnostics) {
    const CameraOverride& asked = options.camera;
    if (viewed.view.lens.radius > 0 || !(asked.focus || asked.aperture.value_or(0) > 0)) return;
    const Graph& graph = viewed.model->graph;
    diagnostics
        .warning(graph.objects[graph.root].span, "the camera has no lens here: all of the picture is sharp")
        .with_hint(
            "a lens needs 'aperture', a camera in perspective that has the focus before it, and no --zoom");
}

/// Where the camera sees neither the model, by its box, nor anything around it.
void warn_of_no_sight(const ViewedModel& viewed, const ViewOptions& options, Diagnostics& diagnostics) {
    const Graph& graph = viewed.model->graph;
    const ObjectBounds& bounds = viewed.model->bounds[graph.root];
    const View& view = viewed.view;
    if (options.zoom.active() || bounds.unbounded || bounds.box.empty() || view.ground || view.haze ||
        view.shows_sky_light || view.lens.radius > 0 || !misses(view.camera, bounds.box, view.size))
        return;
    // Terminals of the last level may reach beyond the limit set.
    if (!misses(view.camera, sight_of(*viewed.model, viewed.steps).bounds, view.size)) return;
    std::string middle;
    for (int axis = 0; axis < 3; ++axis) {
        if (axis > 0) middle += ", ";
        append_number(middle, bounds.box.centre()[axis], 4);
    }
    diagnostics
        .warning(graph.objects[graph.root].span,
                 "the camera sees no part of this model: it looks away from it, or past it")
        .with_hint(fmt::format("leave out the camera to see all of it, or let it look at its middle: "
                               "'look_at: {}'",
                               middle));
}

} // namespace

std::optional<ViewedModel> look_at(std::shared_ptr<const AnalysedModel> model, std::optional<unsigned> steps,
                                   const ViewOptions& options, Diagnostics& diagnostics,
                                   const Control& control) {
    std::optional<ViewedModel> viewed;
    if (options.zoom.active())
        viewed = zoom_in(*model, steps, options, diagnostics, control);
    else
        viewed = {model, steps, view_of(*model, steps, options, false), {}};
    if (!viewed) return std::nullopt;
    viewed->view.quality = options.quality;
    warn_of_no_lens(*viewed, options, diagnostics);
    warn_of_no_sight(*viewed, options, diagnostics);
    if (options.transparent) clear_background(viewed->view);
    return viewed;
}

DetailOptions resolved(DetailOptions asked, const ViewedModel& viewed) {
    asked.steps = viewed.steps;
    if (asked.error_world) asked.error_world = std::min(viewed.zoom.times(*asked.error_world), largest_size);
    return asked;
}

} // namespace graftal
