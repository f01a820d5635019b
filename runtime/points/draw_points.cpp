#include "runtime/points/draw_points.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "compiler/chaos/unroll.h"
#include "compiler/graph/refuse_combined.h"
#include "compiler/session/frame_model.h"
#include "compiler/support/check.h"
#include "runtime/image/develop.h"
#include "runtime/points/accumulation.h"
#include "runtime/points/card.h"
#include "runtime/points/gpu_points.h"
#include "runtime/points/orbit_source.h"
#include "runtime/points/ply_file.h"
#include "runtime/points/point_projection.h"
#include "runtime/points/point_source.h"
#include "runtime/points/shares.h"
#include "runtime/render/gpu_engine.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

constexpr std::uint64_t points_a_pixel = 100;
constexpr std::uint64_t points_of_cloud = 1'000'000;
constexpr std::uint64_t most_bytes_of_copies = 1u << 30;
constexpr std::size_t most_unrolled = 4'000'000;

/// Planes have no end, and so no random point.
void note_planes(const Graph& graph, Diagnostics& diagnostics) {
    for (const Object& object : graph.objects)
        for (const Instance& instance : object.instances)
            if (graph.objects[instance.master].primitive == PrimitiveKind::plane) {
                diagnostics.note(instance.span, "a plane has no end, so it gets no points");
                return;
            }
}

/// `shares`: of the instances of the root, in place of chances by size; none: there are none.
std::optional<ChaosGame> game_of(const AnalysedModel& model, const std::vector<double>& shares,
                                 std::optional<unsigned> steps, Diagnostics& diagnostics) {
    if (refuse_combined(model.graph, "a cloud of random points", diagnostics)) return std::nullopt;
    const double rate = model.contraction.verdict == Verdict::proved ? model.contraction.certificate.rate : 0;
    std::optional<Graph> shared;
    if (!shares.empty()) {
        shared = model.graph;
        std::vector<Instance>& parts = shared->objects[shared->root].instances;
        for (std::size_t i = 0; i < parts.size(); ++i)
            parts[i].chance = shares[i];
    }
    const Graph& graph = shared ? *shared : model.graph;
    std::optional<ChaosGame> game;
    if (steps && model.components.unending[model.graph.root]) {
        const auto cut = unrolled(graph, model.components, model.bounds, *steps, most_unrolled);
        if (cut) {
            const std::vector<ObjectBounds> none(cut->objects.size());
            game = ChaosGame::of(*cut, strong_components(*cut), none, 0);
        } else {
            diagnostics.note(
                model.graph.objects[model.graph.root].span,
                fmt::format("{} levels look the same as infinitely many: graftal draws the limit", *steps));
        }
    }
    if (!game) game = ChaosGame::of(graph, model.components, model.bounds, rate);
    note_planes(model.graph, diagnostics);
    if (!game)
        diagnostics.error(model.graph.objects[model.graph.root].span,
                          "this model contains nothing that could get points");
    return game;
}

/// The picture while its points are coming in.
class Canvas {
  public:
    Canvas(const View& view, const PointsOptions& options, std::uint32_t maps)
        : options_(options), projection_(view.camera, view.size) {
        const auto workers = static_cast<std::size_t>(worker_count(options.threads));
        const std::uint64_t bytes = sizeof(Accumulation::Cell) * static_cast<std::uint64_t>(view.size.width) *
                                    static_cast<std::uint64_t>(view.size.height);
        shared_ = bytes * workers > most_bytes_of_copies;
        copies_.resize(shared_ ? 1 : workers);
        if (shared_) copies_.front() = std::make_unique<Accumulation>(view.size);
        for (std::uint32_t map = 0; map <= maps; ++map)
            map_colours_.push_back(map == 0 ? Rgb(0.6) : map_colour(map - 1));
        size_ = view.size;
    }

    void take(int worker, std::span<const ChaosPoint> points) {
        std::unique_ptr<Accumulation>& own = copies_[shared_ ? 0 : static_cast<std::size_t>(worker)];
        if (!own) own = std::make_unique<Accumulation>(size_); // by the thread that fills it
        std::array<std::size_t, most_at_once> pixels;
        GRAFTAL_CHECK(points.size() <= pixels.size(), "points: a batch too large");
        for (std::size_t i = 0; i < points.size(); ++i) {
            pixels[i] = projection_.pixel_of(points[i].place).value_or(beside);
            // The cells lie all over the memory: asked for now, they are there when they are wanted.
            if (pixels[i] != beside) own->prefetch(pixels[i]);
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            const ChaosPoint& point = points[i];
            if (pixels[i] == beside) continue;
            float by_map[3];
            const float* rgb = point.rgb;
            if (options_.colour == PointColour::map) {
                for (int c = 0; c < 3; ++c)
                    by_map[c] = static_cast<float>(map_colours_[point.map][c]);
                rgb = by_map;
            }
            shared_ ? own->add_shared(pixels[i], rgb) : own->add(pixels[i], rgb);
        }
    }

    /// Adds the points of a source, as a graphics card makes them.
    Status add(const PointSource& source, const PointWork& work, PointsReport& report) {
        std::string why = options_.device ? "" : why_no_card();
        std::optional<FlatGame> game;
        if (why.empty()) game = source.flat(projection_.picture_from_world(), label_colour(), why);
        if (game && !is_sharp_in_single(source, projection_)) {
            why = "single precision does not tell places so near apart";
            game.reset();
        }
        if (!game) return Status::failure(why);
        Status status;
        const std::unique_ptr<Gpu> gpu = Gpu::open(options_.device.value_or(0), status);
        if (!gpu) return status;
        auto counted = std::make_unique<Accumulation>(size_);
        GpuPoints points(*gpu);
        status = points.add_to(*counted, *game,
                               {.points = work.points,
                                .seed = options_.compile.lower.seed.value_or(0),
                                .perspective = projection_.perspective(),
                                .goes_on = [&](double share) {
                                    if (work.on_progress) work.on_progress(share);
                                    return !work.cancelled();
                                }});
        if (!status.ok()) return status;
        copies_.front() = std::move(counted);
        report.seconds = points.seconds();
        report.device = gpu->info().name;
        return {};
    }

    const Accumulation& sum() {
        std::unique_ptr<Accumulation>& all = copies_.front();
        if (!all) all = std::make_unique<Accumulation>(size_);
        for (std::size_t i = 1; i < copies_.size(); ++i)
            if (copies_[i]) {
                all->add(*copies_[i]);
                copies_[i].reset();
            }
        return *all;
    }

    Rgb colour_of(const ChaosPoint& point) const {
        if (options_.colour == PointColour::map) return map_colours_[point.map];
        return {point.rgb[0], point.rgb[1], point.rgb[2]};
    }

  private:
    LabelColour label_colour() const {
        if (options_.colour == PointColour::tint) return {};
        if (options_.colour == PointColour::density) return [](std::uint32_t) { return Rgb(0.0); };
        return [this](std::uint32_t label) { return map_colours_[label]; };
    }

    static constexpr std::size_t most_at_once = 512;
    static constexpr std::size_t beside = SIZE_MAX; ///< the picture

    const PointsOptions& options_;
    PointProjection projection_;
    ImageSize size_;
    bool shared_ = false;
    std::vector<std::unique_ptr<Accumulation>> copies_; ///< by worker
    std::vector<Rgb> map_colours_;
};

PointWork work_for(const PointsOptions& options, const CancelFlag& cancel) {
    return {point_count(options), options.threads, options.on_progress,
            [&cancel] { return cancel.raised(); }};
}

Status take_cloud(const PointSource& source, const PointWork& work, const Canvas& canvas,
                  const std::function<void(std::span<const CloudPoint>)>& take) {
    const auto make = [&](std::span<const ChaosPoint> points, std::vector<char>& bytes) {
        std::vector<CloudPoint> cloud;
        for (const ChaosPoint& point : points)
            cloud.push_back(cloud_point(point.place, canvas.colour_of(point)));
        const char* const begin = reinterpret_cast<const char*>(cloud.data());
        bytes.insert(bytes.end(), begin, begin + cloud.size() * sizeof(CloudPoint));
    };
    const auto write = [&](const std::vector<char>& bytes) {
        std::vector<CloudPoint> cloud(bytes.size() / sizeof(CloudPoint));
        std::memcpy(cloud.data(), bytes.data(), bytes.size());
        take(cloud);
        return true;
    };
    return write_points(source, work, make, write) ? Status() : Status::failure("interrupted");
}

/// `card`: appears with the picture, or neither does.
Status write_picture(Canvas& canvas, const View& view, const PointsOptions& options, PendingFile* card,
                     PointsReport& report) {
    const Accumulation& points = canvas.sum();
    for (const Accumulation::Cell& cell : points.cells())
        report.inside += cell.count;
    Tone tone = options.tone;
    tone.by_density = options.colour == PointColour::density;
    Image image = toned(points, tone, view);
    if (!is_exr_name(options.output)) {
        Film film;
        film.soft = tone.light;
        Developer(film, options.format).develop(image, 0, image.height);
    }
    if (is_exr_name(options.output) && image.channels == 4) // colour belongs to alpha already, as EXR has it
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            if (i % 4 != 3) image.pixels[i] *= image.pixels[i / 4 * 4 + 3];
    PendingFile picture(options.output);
    if (!picture.status().ok()) return picture.status();
    if (Status status = write_image(picture, image, options.format, options.metadata); !status.ok())
        return status;
    if (!card) return picture.commit();
    PendingFile* const both[] = {&picture, card};
    return commit_together(both);
}

} // namespace

bool is_cloud_name(const std::string& path) {
    return std::filesystem::path(path).extension() == ".ply";
}

std::uint64_t point_count(const PointsOptions& options) {
    if (options.points) return *options.points;
    if (is_cloud_name(options.output) || options.take) return points_of_cloud;
    const ImageSize size = options.compile.view.size;
    return points_a_pixel * static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
}

Status place_points(const PointSource& source, const View& view, const PointsOptions& options,
                    PendingFile* card, const CancelFlag& cancel, PointsReport& report) {
    Status status;
    if (!options.take) status = check_writable(options.output);
    if (!status.ok()) return status;
    const PointWork work = work_for(options, cancel);
    Canvas canvas(view, options, report.maps);
    report.points = work.points;
    if (options.take) {
        const Stopwatch watch;
        status = take_cloud(source, work, canvas, options.take);
        report.seconds = watch.seconds();
        report.inside = work.points;
        return status;
    }
    if (is_cloud_name(options.output)) {
        const Stopwatch watch;
        status = write_ply(options.output, source, work, options.metadata,
                           [&](const ChaosPoint& point) { return canvas.colour_of(point); });
        report.seconds = watch.seconds();
        report.inside = work.points;
        return status;
    }
    if (options.gpu) {
        status = canvas.add(source, work, report);
        if (status.ok()) return write_picture(canvas, view, options, card, report);
        if (cancel.raised()) return status;
        report.not_gpu = status.message();
    }
    const Stopwatch watch;
    const bool complete = take_points(
        source, work, [&](int worker, std::span<const ChaosPoint> points) { canvas.take(worker, points); });
    report.seconds = watch.seconds();
    return complete ? write_picture(canvas, view, options, card, report) : Status::failure("interrupted");
}

namespace {

/// Ends the making of points: how long it took, and why a card did not make them.
void note_processors(const Span& span, const PointsReport& report, Compilation& compilation) {
    compilation.times.push_back({"points", report.seconds});
    if (!report.not_gpu.empty())
        compilation.diagnostics.note(
            span, fmt::format("the processors make these points, not the GPU: {}", report.not_gpu));
}

Status place_card(const PointSource& source, const Box& box, const std::vector<Material>& materials,
                  const PointsOptions& options, const CancelFlag& cancel, PointsReport& report) {
    const ImageSize size = options.compile.view.size;
    const std::string picture = std::filesystem::path(options.output).filename().string();
    PendingFile card(options.card);
    if (!card.status().ok()) return card.status();
    if (Status status = write_text(card, card_text(picture, box, size, materials)); !status.ok())
        return status;
    return place_points(source, card_view(box, size), options, &card, cancel, report);
}

void warn_of_lens(const View& view, const Span& span, Diagnostics& diagnostics) {
    if (view.lens.radius > 0) diagnostics.warning(span, "random points have no lens: all of them are sharp");
}

/// A note where each of several sequences leaves out more points than it makes.
void note_skipped(const OrbitModel& model, std::uint64_t points, Diagnostics& diagnostics) {
    if (model.maps.size() == 1 || points <= points_of_stream || model.skip <= points_of_stream) return;
    diagnostics
        .note(model.span, fmt::format("'skip' leaves out {} points before every {} that are drawn",
                                      model.skip, points_of_stream))
        .with_hint("a smaller 'skip' is faster");
}

std::optional<PointsReport> draw_orbit(const OrbitModel& model, const PointsOptions& options,
                                       const CancelFlag& cancel, Compilation& compilation) {
    constexpr std::uint64_t most_surveyed = 1u << 20;
    if (options.compile.view.zoom.active()) {
        compilation.diagnostics.error(model.span, "an orbit has no parts for '--at' and '--zoom'")
            .with_hint("--camera \"look_at=X,Y,0 width=W\" looks closer");
        return std::nullopt;
    }
    const OrbitSource source(model, options.compile.lower.seed.value_or(0));
    note_skipped(model, point_count(options), compilation.diagnostics);
    const auto [box, astray] =
        source.survey(std::min(point_count(options), most_surveyed), [&cancel] { return cancel.raised(); });
    if (source.report(compilation.diagnostics)) return std::nullopt;
    if (cancel.raised()) {
        compilation.status = Status::failure("interrupted");
        return std::nullopt;
    }
    if (astray > 0.9)
        compilation.diagnostics.warning(
            model.span, fmt::format("{:.0f} of 100 points of this orbit run away or have no value, and begin "
                                    "again at random: there is little else in the picture",
                                    std::floor(100 * astray)));
    PointsReport report;
    report.maps = static_cast<std::uint32_t>(model.maps.size());
    const View view = frame_graph(model.scene, {box, {}}, options.compile.view);
    warn_of_lens(view, model.span, compilation.diagnostics);
    compilation.status = options.card.empty() ? place_points(source, view, options, nullptr, cancel, report)
                                              : place_card(source, box, {}, options, cancel, report);
    if (source.report(compilation.diagnostics)) compilation.status = Status(); // which is why it was given up
    note_processors(model.span, report, compilation);
    if (!compilation.status.ok() || compilation.diagnostics.has_errors()) return std::nullopt;
    return report;
}

} // namespace

std::optional<PointsReport> draw_points(PictureSession& session, const PointsOptions& options,
                                        Compilation& compilation) {
    const CancelFlag& cancel = session.control().cancel;
    StageOptions compile = options.compile;
    compile.lower.may_be_orbit = true;
    std::shared_ptr<const OrbitModel> orbit;
    if (const auto lowered = session.lowered(compile, compilation))
        orbit = lowered->notes.orbit;
    else
        return std::nullopt;
    if (orbit) return draw_orbit(*orbit, options, cancel, compilation);
    const std::shared_ptr<const ViewedModel> viewed = session.viewed(compile, compilation);
    if (!viewed) return std::nullopt;
    const Stopwatch watch;
    // Clouds and cards have no eye: there points lie evenly in space.
    const bool has_eye = options.card.empty() && !options.take && !is_cloud_name(options.output);
    const std::vector<double> shares =
        has_eye ? shown_sizes(*viewed->model, viewed->view) : std::vector<double>();
    warn_of_missed_parts(*viewed->model, shares, compilation.diagnostics);
    const std::optional<ChaosGame> game =
        game_of(*viewed->model, shares, viewed->steps, compilation.diagnostics);
    compilation.times.push_back({"chances", watch.seconds()});
    if (!game) return std::nullopt;
    PointsReport report;
    report.maps = game->map_count();
    const ChaosSource source(*game, compile.lower.seed.value_or(0));
    const Graph& graph = viewed->model->graph;
    warn_of_lens(viewed->view, graph.objects[graph.root].span, compilation.diagnostics);
    const Box& box = viewed->model->bounds[graph.root].box;
    compilation.status = options.card.empty()
                             ? place_points(source, viewed->view, options, nullptr, cancel, report)
                             : place_card(source, box, graph.materials, options, cancel, report);
    note_processors(graph.objects[graph.root].span, report, compilation);
    if (!compilation.status.ok()) return std::nullopt;
    return report;
}

} // namespace graftal
