#include "runtime/graftal/model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/analysis/counts.h"
#include "compiler/session/stages.h"
#include "compiler/session/stats.h"
#include "runtime/graftal/listed_graph.h"
#include "runtime/graftal/model_parts.h"
#include "runtime/points/draw_points.h"

namespace graftal::v1 {

namespace {

std::optional<Vec3> vec3_of(const std::optional<Vector>& v) {
    return v ? std::optional(Vec3(v->x, v->y, v->z)) : std::nullopt;
}

Vector vector_of(Vec3 v) {
    return {v.x, v.y, v.z};
}

Parameter parameter_of(const ModelParameter& known, const SourceMap& sources) {
    const Span& span = known.span;
    const Position at = sources.position(span.file, span.begin);
    Parameter parameter{.name = known.name,
                        .value = known.value,
                        .least = {},
                        .most = {},
                        .literal = known.literal,
                        .file = std::string(sources.name(span.file)),
                        .line = at.line,
                        .column = at.column,
                        .begin = span.begin,
                        .end = span.end};
    if (known.kind == ModelParameter::Kind::inner) parameter.least = 0, parameter.most = 1;
    return parameter;
}

constexpr std::uint64_t most_points = 1'000'000'000;

} // namespace

Model::Model(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;
Model::~Model() = default;

Model Model::from_file(std::string path) {
    return Model(std::make_unique<Parts>(std::move(path)));
}

Model Model::from_text(std::string name, std::string text) {
    Model model(std::make_unique<Parts>(std::move(name)));
    model.edit(std::move(text));
    return model;
}

void Model::put_file(const std::string& path, std::string text) {
    parts_->files.set(path, std::move(text));
}

void Model::edit(std::string text) {
    parts_->session.edit(std::move(text));
}

void Model::reload() {
    parts_->session.reload();
}

void Model::set(const std::string& name, double value) {
    parts_->options.compile.lower.set[name] = value;
}

void Model::unset(const std::string& name) {
    auto& set = parts_->options.compile.lower.set;
    if (const auto known = set.find(name); known != set.end()) set.erase(known);
}

void Model::steps(std::optional<unsigned> steps) {
    parts_->options.compile.lower.steps = steps;
    parts_->options.compile.lower.time.reset();
}

void Model::time(double steps) {
    if (steps >= 0 && steps <= UINT32_MAX && steps == std::floor(steps)) {
        this->steps(static_cast<unsigned>(steps));
        return;
    }
    parts_->options.compile.lower.steps.reset();
    parts_->options.compile.lower.time = steps;
}

void Model::seed(std::optional<std::uint64_t> seed) {
    parts_->options.compile.lower.seed = seed;
}

void Model::camera(const Camera& camera) {
    CameraOverride& asked = parts_->options.compile.view.camera;
    asked = {.location = vec3_of(camera.location),
             .look_at = vec3_of(camera.look_at),
             .up = vec3_of(camera.up),
             .direction = {},
             .angle_deg = camera.angle_deg,
             .orthographic = camera.orthographic,
             .width = camera.width,
             .height = {},
             .aperture = asked.aperture,
             .focus = asked.focus};
}

void Model::lens(std::optional<double> aperture, const std::optional<Vector>& focus) {
    CameraOverride& asked = parts_->options.compile.view.camera;
    asked.aperture = aperture;
    asked.focus = vec3_of(focus);
}

void Model::size(int width, int height) {
    parts_->options.compile.view.size = {std::max(width, 1), std::max(height, 1)};
}

void Model::zoom(std::optional<double> factor) {
    parts_->options.compile.view.zoom.zoom =
        factor ? std::optional(Magnification::of(*factor)) : std::nullopt;
}

void Model::error_px(double pixels) {
    parts_->options.compile.detail.error_px = pixels;
    parts_->error_asked = true;
}

void Model::memory(std::uint64_t bytes) {
    parts_->options.compile.detail.memory_bytes = bytes;
}

void Model::work(double seconds) {
    parts_->options.limit_work(seconds);
}

void Model::threads(int count) {
    parts_->options.threads = count;
}

void Model::antialias(std::optional<int> depth) {
    constexpr int deepest = 9;
    parts_->options.antialias = depth ? std::optional(std::clamp(*depth, 1, deepest)) : std::nullopt;
}

void Model::quality(Quality quality) {
    static constexpr graftal::Quality qualities[] = {graftal::Quality::draft, graftal::Quality::normal,
                                                     graftal::Quality::best};
    parts_->options.compile.view.quality = qualities[static_cast<std::size_t>(quality)];
}

void Model::root(std::string folder) {
    parts_->options.compile.lower.root = std::move(folder);
}

void Model::on_progress(OnProgress listener) {
    parts_->listener = std::move(listener);
}

void Model::cancel() {
    parts_->cancelled = true;
}

Result<std::vector<Parameter>> Model::parameters() {
    return parts_->run<std::vector<Parameter>>(
        [this](Compilation& compilation) -> std::optional<std::vector<Parameter>> {
            const auto model = parts_->session.lowered(parts_->options.compile, compilation);
            if (!model) return std::nullopt;
            std::vector<Parameter> parameters;
            for (const ModelParameter& known : model->notes.parameters)
                parameters.push_back(parameter_of(known, compilation.sources));
            return parameters;
        });
}

Result<Stats> Model::stats() {
    return parts_->run<Stats>([this](Compilation& compilation) -> std::optional<Stats> {
        const StageOptions& stages = parts_->options.compile;
        const auto model = parts_->session.analysed(stages, compilation, true);
        if (!model) return std::nullopt;
        const std::optional<unsigned> levels = levels_of(*model, stages.lower.steps);
        Stats stats;
        stats.objects = model->graph.objects.size();
        stats.instances = edge_count(model->graph);
        stats.steps = model->derivation ? model->derivation->steps : levels;
        stats.primitives = count_leaves(model->graph, model->components, levels).value_or("");
        if (!model->bounds.empty()) {
            stats.dimension = similarity_dimension(model->graph, model->components);
            const Box& box = model->bounds[model->graph.root].box;
            if (!box.empty()) {
                stats.least = vector_of(box.min);
                stats.most = vector_of(box.max);
            }
        }
        stats.json = stats_json(*model, levels, compilation.sources);
        return stats;
    });
}

Result<ObjectGraph> Model::graph() {
    return parts_->run<ObjectGraph>([this](Compilation& compilation) -> std::optional<ObjectGraph> {
        const auto model = parts_->session.analysed(parts_->options.compile, compilation, true);
        if (!model) return std::nullopt;
        return listed_graph(model->graph, compilation.status);
    });
}

Result<Points> Model::points(std::uint64_t count) {
    return parts_->run<Points>([&](Compilation& compilation) -> std::optional<Points> {
        if (count > most_points) {
            compilation.status =
                Status::failure(fmt::format("{} points at once: ask for at most {}", count, most_points));
            return std::nullopt;
        }
        PointsOptions options;
        options.compile = parts_->options.compile;
        options.threads = parts_->options.threads;
        options.points = count;
        options.on_progress = [this](double share) { parts_->tell("points", share); };
        Points points;
        points.places.reserve(3 * count);
        points.rgb.reserve(3 * count);
        options.take = [&](std::span<const CloudPoint> cloud) {
            for (const CloudPoint& point : cloud) {
                points.places.insert(points.places.end(), point.place, point.place + 3);
                points.rgb.insert(points.rgb.end(), point.rgb, point.rgb + 3);
            }
        };
        if (!draw_points(parts_->session, options, compilation)) return std::nullopt;
        return points;
    });
}

Runs Model::runs() const {
    const StageRuns runs = parts_->session.runs();
    return {runs.parsed, runs.lowered, runs.analysed, runs.prepared};
}

} // namespace graftal::v1
