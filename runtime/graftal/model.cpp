#include "runtime/graftal/model.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/analysis/counts.h"
#include "compiler/lower/plant.h"
#include "compiler/povray/cut/compile.h"
#include "compiler/session/stages.h"
#include "compiler/session/stats.h"
#include "compiler/support/number_range.h"
#include "runtime/export/export_model.h"
#include "runtime/export/plant_files.h"
#include "runtime/graftal/library_words.h"
#include "runtime/graftal/listed_graph.h"
#include "runtime/image_files/image_files.h"
#include "runtime/plants/measures_report.h"
#include "runtime/plants/plant_of_model.h"
#include "runtime/points/draw_points.h"
#include "runtime/render/aov_channels.h"
#include "runtime/render/file_film.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/render.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/disk_files.h"

namespace graftal::v1 {

namespace {

std::optional<Vec3> vec3_of(const std::optional<Vector>& v) {
    return v ? std::optional(Vec3(v->x, v->y, v->z)) : std::nullopt;
}

Vector vector_of(Vec3 v) {
    return {v.x, v.y, v.z};
}

Severity severity_of(graftal::Severity severity) {
    switch (severity) {
    case graftal::Severity::error:
        return Severity::error;
    case graftal::Severity::warning:
        return Severity::warning;
    case graftal::Severity::note:
        break;
    }
    return Severity::note;
}

Message message_of(const Diagnostic& finding, const SourceMap& sources) {
    Message message{severity_of(finding.severity), {}, 0, 0, in_library_words(finding.message),
                    in_library_words(finding.hint)};
    if (!finding.span.known()) return message;
    const Position at = sources.position(finding.span.file, finding.span.begin);
    message.file = sources.name(finding.span.file);
    message.line = at.line;
    message.column = at.column;
    return message;
}

std::vector<Message> messages_of(const Compilation& compilation) {
    std::vector<Message> messages;
    for (const Diagnostic& finding : compilation.diagnostics.all())
        messages.push_back(message_of(finding, compilation.sources));
    if (!compilation.status.ok())
        messages.push_back({Severity::error, {}, 0, 0, in_library_words(compilation.status.message()), {}});
    return messages;
}

Picture picture_of(const Image& image) {
    Picture picture{image.width, image.height, {}};
    picture.rgb.reserve(image.pixels.size());
    for (const float sample : image.pixels)
        picture.rgb.push_back(level8_of(sample));
    return picture;
}

/// Hands the tiles on.
class TileFilm final : public PictureFilm {
  public:
    explicit TileFilm(const OnTile& listener) : listener_(listener) {}
    void begin(const PictureShape& shape) override { window_ = shape.window; }
    void tile(const graftal::Tile& tile, const Image& picture, int pass) override {
        const auto row_floats = 3 * static_cast<std::size_t>(picture.width);
        const std::size_t first = row_floats * static_cast<std::size_t>(tile.y - window_.y) +
                                  3 * static_cast<std::size_t>(tile.x - window_.x);
        listener_({tile.x, tile.y, tile.width, tile.height, &picture.pixels[first], row_floats, pass});
    }
    Status end(int, const Image&, const AovPicture*) override { return {}; }

  private:
    const OnTile& listener_;
    graftal::Tile window_;
};

/// Keeps the light and the AOVs of the last pass.
class ChannelFilm final : public PictureFilm {
  public:
    void begin(const PictureShape& shape) override { shape_.emplace(shape); }
    void tile(const graftal::Tile&, const Image&, int) override {}
    Status end(int, const Image& picture, const AovPicture* aovs) override {
        const MoreChannels more = aov_channels(*aovs, shape_->cut, shape_->view);
        channels_ = {picture.width, picture.height, {"R", "G", "B"}, {}, ObjectNumbers(shape_->cut).names()};
        channels_.names.insert(channels_.names.end(), more.names.begin(), more.names.end());
        channels_.samples.reserve(aovs->pixels.size() * channels_.names.size());
        auto light = picture.pixels.begin();
        for (auto others = more.samples.begin(); others != more.samples.end(); light += 3) {
            const auto end = others + static_cast<std::ptrdiff_t>(more.names.size());
            channels_.samples.insert(channels_.samples.end(), light, light + 3);
            channels_.samples.insert(channels_.samples.end(), others, end);
            others = end;
        }
        return {};
    }
    Channels& channels() { return channels_; }

  private:
    std::optional<PictureShape> shape_; ///< since begin()
    Channels channels_;
};

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

const char* name_of(Severity severity) {
    static constexpr const char* names[] = {"error", "warning", "note"};
    return names[static_cast<std::size_t>(severity)];
}

std::string text_of(const std::vector<Message>& messages) {
    std::string text;
    for (const Message& message : messages) {
        if (!message.file.empty())
            text += fmt::format("{}:{}:{}: ", message.file, message.line, message.column);
        text += fmt::format("{}: {}\n", name_of(message.severity), message.text);
        if (!message.hint.empty()) text += fmt::format("  {}\n", message.hint);
    }
    return text;
}

struct Model::Parts {
    explicit Parts(std::string name) : path(std::move(name)), session(path, Keep::everything, files) {
        session.set_control(
            {CancelFlag([this] { return cancelled.load(); }), [this](const Progress& progress) {
                 const auto done = static_cast<double>(progress.done);
                 const auto total = static_cast<double>(progress.total);
                 tell(progress.stage, total > 0 ? std::optional(done / total) : std::nullopt);
             }});
    }

    void tell(std::string_view stage, std::optional<double> share) const {
        const std::lock_guard one_at_a_time(telling);
        if (listener) listener(stage, share ? std::optional(std::clamp(*share, 0.0, 1.0)) : std::nullopt);
    }

    /// For an engine, which tells the listener.
    RenderOptions told() const {
        RenderOptions render = options;
        render.on_progress = [this](const DrawProgress& progress) { tell("draw", progress.fraction); };
        return render;
    }

    /// The light on plants, within the work that is set, or as much as commands take.
    PlantLightOptions light_options(int samples) const {
        PlantLightOptions light;
        light.most_samples = samples;
        light.work_seconds = options.work_seconds.value_or(light.work_seconds);
        return light;
    }

    bool draw(PictureFilm& film, RenderOptions render, Compilation& compilation) {
        render.film = &film;
        return render_natively(session, render, compilation).has_value();
    }

    /// Calls a function that gives a value or nothing.
    template<typename Value, typename Work> Result<Value> run(const Work& work) {
        cancelled = false;
        Compilation compilation;
        std::optional<Value> value = work(compilation);
        if (cancelled) return {std::nullopt, {}, true};
        return {std::move(value), messages_of(compilation), false};
    }

    MemoryFiles files{&disk_files()}; ///< texts of the caller, over those of the disk
    std::string path;                 ///< of the model
    PictureSession session;
    RenderOptions options;
    bool error_asked = false;
    OnProgress listener;
    mutable std::mutex telling;
    std::atomic<bool> cancelled = false;
};

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
    parts_->options.antialias = depth;
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

namespace {

/// The notes of a lowering that keeps something in place of a graph.
std::shared_ptr<const LoweredModel> lowered_in_place(Session& session, StageOptions stages,
                                                     LowerOptions::InPlace wanted, Compilation& compilation) {
    stages.lower.in_place = wanted;
    stages.lower.may_be_orbit = true;
    std::shared_ptr<const LoweredModel> lowered = session.lowered(stages, compilation);
    if (!lowered || compilation.diagnostics.has_errors()) return nullptr;
    if (lowered->notes.word || lowered->notes.plant) return lowered;
    compilation.diagnostics.error(Span(), "only L-systems have a word and its modules");
    return nullptr;
}

PlantTable table_of(const Plant& plant) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto row_or_none = [](std::uint32_t row) {
        return row == PlantModule::none ? -1 : std::int64_t{row};
    };
    PlantTable table;
    for (const PlantModule& module : plant.modules)
        table.parameter_count = std::max(table.parameter_count, module.parameters.size());
    for (const PlantModule& module : plant.modules) {
        table.names.push_back(plant.names[module.name]);
        table.parents.push_back(row_or_none(module.parent));
        table.branches.push_back(module.branches);
        table.orders.push_back(module.order);
        table.ranks.push_back(module.rank);
        table.parts_of.push_back(row_or_none(module.part_of));
        table.organs.emplace_back(name_of(module.organ));
        table.materials.push_back(module.material == PlantModule::no_name ? ""
                                                                          : plant.materials[module.material]);
        table.ages.push_back(module.age);
        table.lengths.push_back(module.length);
        table.widths.push_back(module.width);
        table.areas.push_back(module.is_measured ? module.area : unknown);
        table.volumes.push_back(module.is_measured ? module.volume : unknown);
        for (const auto& [of, vector] : {std::pair(&table.starts, module.start),
                                         {&table.ends, module.end},
                                         {&table.headings, module.heading},
                                         {&table.lefts, module.left},
                                         {&table.ups, module.up}})
            of->insert(of->end(), {vector.x, vector.y, vector.z});
        table.parameters.insert(table.parameters.end(), module.parameters.begin(), module.parameters.end());
        table.parameters.resize(table.names.size() * table.parameter_count, unknown);
    }
    return table;
}

} // namespace

Result<std::string> Model::word() {
    return parts_->run<std::string>([this](Compilation& compilation) -> std::optional<std::string> {
        const auto lowered = lowered_in_place(parts_->session, parts_->options.compile,
                                              LowerOptions::InPlace::word, compilation);
        return lowered ? lowered->notes.word : std::nullopt;
    });
}

Result<PlantTable> Model::plant() {
    return parts_->run<PlantTable>([this](Compilation& compilation) -> std::optional<PlantTable> {
        const auto lowered = lowered_in_place(parts_->session, parts_->options.compile,
                                              LowerOptions::InPlace::plant, compilation);
        if (!lowered || !lowered->notes.plant) return std::nullopt;
        return table_of(*lowered->notes.plant);
    });
}

Result<PlantReport> Model::measures(const MeasureSettings& settings) {
    return parts_->run<PlantReport>([&](Compilation& compilation) -> std::optional<PlantReport> {
        if ((settings.ground_area && !(*settings.ground_area > 0)) || settings.samples < 4) {
            compilation.status = Status::failure("ground_area is not above 0, or samples is less than 4");
            return std::nullopt;
        }
        const StageOptions& stages = parts_->options.compile;
        const auto plant = plant_of_model(parts_->session, stages,
                                          "only L-systems have a plant that can be measured", compilation);
        if (!plant) return std::nullopt;
        const auto measures =
            measures_of_model(parts_->session, stages, *plant, settings.ground_area, compilation);
        if (!measures) return std::nullopt;
        PlantReport report;
        std::optional<PlantLight> light;
        if (settings.irradiance) {
            light = light_of_model(parts_->session, parts_->options, *plant,
                                   parts_->light_options(settings.samples), compilation);
            if (!light) return std::nullopt;
            for (const OrganLight& organ : light->organs) {
                report.lights.push_back(organ.light);
                report.errors.push_back(organ.error);
                report.absorbed.push_back(organ.absorbed);
                report.sunlit.push_back(organ.sunlit);
            }
        }
        report.json = measures_json(parts_->path, *measures, light ? &*light : nullptr);
        return report;
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

Result<Picture> Model::render() {
    return parts_->run<Picture>([this](Compilation& compilation) -> std::optional<Picture> {
        const RenderOptions options = parts_->told();
        MemoryFilm film(options);
        if (!parts_->draw(film, options, compilation)) return std::nullopt;
        return picture_of(film.picture());
    });
}

Result<Channels> Model::aovs() {
    return parts_->run<Channels>([this](Compilation& compilation) -> std::optional<Channels> {
        RenderOptions options = parts_->told();
        options.aovs = true;
        options.output = "memory.exr"; // is never written
        ChannelFilm film;
        if (!parts_->draw(film, options, compilation)) return std::nullopt;
        return std::move(film.channels());
    });
}

Result<Drawn> Model::draw(const OnTile& listener) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        const Stopwatch watch;
        TileFilm film(listener);
        RenderOptions options = parts_->told();
        options.progressive = true;
        if (!parts_->draw(film, options, compilation)) return std::nullopt;
        return Drawn{{}, watch.seconds()};
    });
}

Runs Model::runs() const {
    const StageRuns runs = parts_->session.runs();
    return {runs.parsed, runs.lowered, runs.analysed, runs.prepared};
}

Result<Drawn> Model::render_to(const std::string& path, Engine engine) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        if (!is_picture_name(path)) {
            compilation.status = Status::failure("'" + path + "' ends neither in .png nor in .exr");
            return std::nullopt;
        }
        const Stopwatch watch;
        RenderOptions render = parts_->told();
        render.output = path;
        const graftal::Engine* const drawing = find_engine(engine == Engine::povray ? "povray" : "native");
        if (!drawing->draw(parts_->session, render, compilation)) return std::nullopt;
        return Drawn{path, watch.seconds()};
    });
}

Result<Drawn> Model::compile_to(const std::string& path) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        const bool include = path.ends_with(".inc");
        if (!include && !path.ends_with(".pov")) {
            compilation.status = Status::failure("'" + path + "' ends neither in .pov nor in .inc");
            return std::nullopt;
        }
        const Stopwatch watch;
        const auto model = compile_scene(parts_->session, parts_->options.compile, compilation);
        if (!model) return std::nullopt;
        compilation.status = write_scene(*model, path, {.include = include}, parts_->session.textures(),
                                         parts_->session.control().cancel);
        if (!compilation.status.ok()) return std::nullopt;
        return Drawn{path, watch.seconds()};
    });
}

Result<Drawn> Model::export_to(const std::string& path, const ExportSettings& settings) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        const auto fail = [&](std::string why) {
            compilation.status = Status::failure(std::move(why));
            return std::nullopt;
        };
        const ExportFormat* const format = find_export_format(path);
        const PlantFormat* const plant = find_plant_format(path);
        if (!format && !plant)
            return fail(fmt::format("'{}' does not end in {}; {}", path, export_endings(), plant_endings()));
        const StageOptions& stages = parts_->options.compile;
        const ExportModelOptions options{stages,
                                         parts_->error_asked,
                                         {.output = path,
                                          .most_bytes = settings.most_bytes,
                                          .fitted_bytes = settings.most_bytes == ExportSettings().most_bytes
                                                              ? ExportOptions().fitted_bytes
                                                              : settings.most_bytes,
                                          .unit_mm = settings.unit_mm,
                                          .levels = settings.levels,
                                          .instancing = settings.instancing,
                                          .plotter = settings.plotter,
                                          .memory_bytes = stages.detail.memory_bytes,
                                          .nodes = settings.nodes,
                                          .metadata = {}}};
        const Stopwatch watch;
        if (!format) {
            std::string vain = vain_plant_wish(*plant, options.file, false);
            if (!vain.empty()) return fail(std::move(vain));
            const PlantLightOptions light = parts_->light_options(PlantLightOptions().most_samples);
            if (!export_plant(parts_->session, parts_->options, *plant, options.file,
                              settings.irradiance ? &light : nullptr, compilation))
                return std::nullopt;
            return Drawn{path, watch.seconds()};
        }
        if (settings.irradiance)
            return fail(fmt::format("irradiance is for {}, not for {}", plant_endings(), format->extension));
        if (const ExportWish* const wish = find_vain_wish(*format, options.file))
            return fail(fmt::format("{} is for {}, not for {}", wish->option, endings_with(wish->has),
                                    format->extension));
        if (settings.unit_mm && !(*settings.unit_mm > 0 && is_size(*settings.unit_mm)))
            return fail("unit is not a positive number of millimetres");
        if (settings.levels && *settings.levels < 2) return fail("levels is less than 2");
        if (settings.nodes && *settings.nodes < 1) return fail("nodes is less than 1");
        if (!export_model(parts_->session, options, compilation)) return std::nullopt;
        return Drawn{path, watch.seconds()};
    });
}

} // namespace graftal::v1
