#include "compiler/compile.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/analysis/model_range.h"
#include "compiler/frame_model.h"
#include "compiler/graph/verify.h"
#include "compiler/support/check.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

/// Runs stages and notes how long each took.
class Stages {
  public:
    explicit Stages(std::vector<StageTime>& times) : times_(times) {}

    template<typename Work> auto run(const char* stage, const Work& work) {
        const auto begin = std::chrono::steady_clock::now();
        try {
            auto result = work();
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
            times_.push_back({stage, elapsed.count()});
            return result;
        } catch (const std::exception&) {
            rethrow_in_stage(stage);
        }
    }

  private:
    std::vector<StageTime>& times_;
};

bool is_pass_or_empty(const std::string& name, Diagnostics& diagnostics) {
    std::vector<std::string> names;
    for (const Pass& pass : pipeline())
        names.emplace_back(pass.name);
    if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return true;
    diagnostics.error({}, fmt::format("there is no pass '{}'", name))
        .with_hint(fmt::format("the passes are {}", fmt::join(names, ", ")));
    return false;
}

Graph optimise(Graph graph, const PipelineOptions& options, std::vector<StageTime>& times) {
    std::vector<PassTime> pass_times;
    graph = run_pipeline(std::move(graph), options, &pass_times);
    for (PassTime& time : pass_times)
        times.push_back({std::move(time.name), time.seconds});
    return graph;
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

void report_refuted(const Graph& graph, const Contraction& contraction, Diagnostics& diagnostics) {
    const std::vector<GraphStep>& cycle = contraction.worst_cycle;
    diagnostics
        .error(span_of(graph, cycle.front()),
               fmt::format("the cycle {} does not contract: its spectral radius is {}{}",
                           describe_cycle(graph, cycle), digits(contraction.rate(), 6),
                           cycle.size() > 1 ? " an instance" : ""))
        .with_hint("an object may contain itself only if every way round makes it smaller: scale down an "
                   "instance of the cycle");
}

void report_undecided(const Graph& graph, const Contraction& contraction, Diagnostics& diagnostics) {
    const std::vector<GraphStep>& cycle = contraction.worst_cycle;
    const Span span = cycle.empty() ? graph.objects[graph.root].span : span_of(graph, cycle.front());
    Diagnostic& error = diagnostics.error(
        span,
        fmt::format("cannot prove that every cycle contracts: the factor an instance lies between {} and {}",
                    digits(contraction.lower, 12), digits(contraction.upper, 12)));
    error.with_hint("a slightly smaller scale on the instances that expand settles it");
    if (!cycle.empty())
        error.with_note(span,
                        fmt::format("the cycle that contracts least is {}", describe_cycle(graph, cycle)));
}

/// Whether the limit of the unfolding is known to exist.
bool converges(const Contraction& contraction) {
    return contraction.verdict == Verdict::acyclic || contraction.verdict == Verdict::proved;
}

void report_verdict(const Graph& graph, const Contraction& contraction, Diagnostics& diagnostics) {
    if (contraction.verdict == Verdict::refuted)
        report_refuted(graph, contraction, diagnostics);
    else
        report_undecided(graph, contraction, diagnostics);
}

View view_of(const AnalysedModel& model, const CompileOptions& options, bool part) {
    return options.frame ? options.frame(model, part) : frame_model(model, options.size, options.camera);
}

/// What frames an object as if it were the model; the camera that the model gives is meant for its root.
FrameObject framing_of(const AnalysedModel& model, const CompileOptions& options) {
    return [&](ObjectId object, unsigned used_levels) {
        if (object == model.graph.root) return view_of(model, options, false);
        AnalysedModel part = model;
        part.graph.root = object;
        part.graph.settings.camera.reset();
        if (part.steps) *part.steps -= used_levels;
        return view_of(part, options, true);
    };
}

/// Gives the model a new root at the place that the zoom asks for.
std::optional<View> zoom_model(AnalysedModel& model, const CompileOptions& options, DetailOptions& detail,
                               Diagnostics& diagnostics) {
    std::optional<Vec3> look_at = options.camera.look_at;
    if (!look_at && model.graph.settings.camera) look_at = model.graph.settings.camera->look_at;
    std::optional<Rerooted> rerooted = reroot({model.graph, model.components, model.bounds, model.steps},
                                              options.zoom, framing_of(model, options), look_at, diagnostics);
    if (!rerooted) return std::nullopt;
    model.graph = std::move(rerooted->graph);
    model.components = std::move(rerooted->components);
    model.bounds = std::move(rerooted->bounds);
    detail.root_levels = std::move(rerooted->root_levels);
    if (detail.error_world)
        detail.error_world = std::min(rerooted->zoom.times(*detail.error_world), largest_size);
    return std::move(rerooted->view);
}

} // namespace

std::optional<AnalysedModel> analyse_model(const std::string& path, const CompileOptions& options,
                                           Compilation& compilation, bool for_report) {
    Diagnostics& diagnostics = compilation.diagnostics;
    if (!is_pass_or_empty(options.pipeline.stop_after, diagnostics)) return std::nullopt;
    Stages stages(compilation.times);

    AnalysedModel model;
    model.path = path;
    LowerOptions lower_options = options.lower;
    lower_options.steps = options.steps;
    std::optional<Graph> lowered = stages.run("lower", [&] {
        return lower_model(path, lower_options, compilation.sources, diagnostics, compilation.status,
                           &model.derivation);
    });
    if (!lowered && model.derivation && lower_options.may_draw_nothing && !diagnostics.has_errors())
        return model;
    if (!lowered) return std::nullopt;
    check_verified(*lowered, "after lowering");
    model.written = {lowered->objects.size(), instance_count(*lowered) + run_part_count(*lowered)};

    PipelineOptions pipeline = options.pipeline;
    pipeline.keep_names |= options.zoom.active();
    model.graph = optimise(std::move(*lowered), pipeline, compilation.times);
    // The steps of an L-system are spent already; what it places recurs as its own file says.
    model.steps = options.steps && !model.derivation ? options.steps : model.graph.settings.steps;
    model.components = stages.run("components", [&] { return strong_components(model.graph); });
    model.contraction =
        stages.run("contraction", [&] { return decide_contraction(model.graph, model.components); });
    if (!converges(model.contraction)) {
        if (for_report) return model;
        report_verdict(model.graph, model.contraction, diagnostics);
        return std::nullopt;
    }

    model.bounds = stages.run(
        "bounding", [&] { return bound_objects(model.graph, model.components, model.contraction); });
    if (!check_range(model.graph, model.components, model.bounds, diagnostics)) return std::nullopt;
    return model;
}

std::optional<ViewedModel> view_model(const std::string& path, const CompileOptions& options,
                                      Compilation& compilation) {
    std::optional<AnalysedModel> model = analyse_model(path, options, compilation);
    if (!model) return std::nullopt;
    DetailOptions detail = options.detail;
    detail.steps = model->steps;
    std::optional<View> view = Stages(compilation.times).run("frame", [&] {
        return options.zoom.active() ? zoom_model(*model, options, detail, compilation.diagnostics)
                                     : view_of(*model, options, false);
    });
    if (!view) return std::nullopt;
    return ViewedModel{std::move(*model), std::move(*view), std::move(detail)};
}

std::optional<CompiledModel> compile_model(const std::string& path, const CompileOptions& options,
                                           Compilation& compilation) {
    std::optional<ViewedModel> viewed = view_model(path, options, compilation);
    if (!viewed) return std::nullopt;
    AnalysedModel& model = viewed->model;
    std::optional<Cut> cut = Stages(compilation.times).run("cut", [&] {
        return cut_graph(model.graph, model.components, model.bounds, viewed->view, viewed->detail,
                         compilation.diagnostics, options.cut);
    });
    if (!cut) return std::nullopt;
    return CompiledModel{std::move(model), std::move(viewed->view), std::move(*cut)};
}

} // namespace graftal
