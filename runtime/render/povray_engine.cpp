#include "runtime/render/povray_engine.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fmt/format.h>

#include "compiler/povray/cut/overlap.h"
#include "compiler/scene/light_list.h"
#include "runtime/image/develop.h"
#include "runtime/povray/povray.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

double povray_seconds(Quality quality) {
    return by_quality(quality, 20.0, 40.0, 1200.0);
}

namespace {

/// Where the scene goes: the directory to keep, or a temporary one.
Status choose_directory(const std::string& keep, TemporaryDirectory& temporary, std::string& directory) {
    if (keep.empty()) {
        Status status = temporary.create();
        directory = temporary.path();
        return status;
    }
    std::error_code error;
    std::filesystem::create_directories(keep, error);
    directory = keep;
    return error ? Status::failure(fmt::format("cannot make the directory '{}': {}", keep, error.message()))
                 : Status();
}

PovrayReport report_of(const Cut& cut) {
    PovrayReport report;
    report.leaf_count = cut.leaf_count;
    report.placement_count = cut.placement_count;
    report.triangle_count = cut.triangle_count;
    report.error_px = cut.error_px;
    report.estimated_bytes = cut.estimated_bytes;
    return report;
}

/// The picture that POV-Ray left becomes the one that was asked for.
Status finish_picture(const PovrayJob& job, const RenderOptions& options, const Film& film,
                      const CancelFlag& cancel) {
    const std::string raw = job.directory + "/" + job.picture;
    Image image;
    Status status = read_povray_image(raw, image);
    std::error_code ignored;
    std::filesystem::remove(raw, ignored);
    if (!status.ok()) return status;
    if (cancel.raised()) return Status::failure("interrupted");
    if (image.width != job.width || image.height != job.height)
        return Status::failure(fmt::format("POV-Ray wrote a picture of {} x {} pixels, not {} x {}",
                                           image.width, image.height, job.width, job.height));
    if (!is_exr_name(options.output) && job.format == PovrayJob::Format::half)
        Developer(film, options.format).develop(image, 0, image.height);
    return write_image(options.output, image, options.format, options.metadata);
}

/// Number of finite objects that POV-Ray must count: every placement except those of planes and of operands,
/// and what the operands make.
void count_objects(const Cut& cut, PovrayJob& job) {
    const auto stands = [](const CombinedPart& part) { return part.holder == no_operand; };
    job.may_be_empty = static_cast<std::uint64_t>(std::ranges::count_if(cut.combined, stands));
    std::uint64_t count = job.may_be_empty;
    for (const PlacementGroup& group : cut.groups) {
        if (group.operand != no_operand) continue;
        for (const Placement& placement : group.placements) {
            const auto* primitive = std::get_if<Primitive>(&cut.bodies[placement.body].shape);
            count += !primitive || *primitive != PrimitiveKind::plane;
        }
        for (const PackedPlacements& parts : group.packed)
            count += parts.size();
    }
    job.finite_objects = count;
}

const char* name_of(PovrayProgress::Stage stage) {
    switch (stage) {
    case PovrayProgress::Stage::parsing:
        return "reading the scene";
    case PovrayProgress::Stage::bounding:
        return "sorting the scene";
    case PovrayProgress::Stage::rendering:
        return "rendering";
    }
    return "";
}

PovrayJob job_for(const RenderOptions& options, const View& view) {
    PovrayJob job;
    job.width = view.size.width;
    job.height = view.size.height;
    job.threads = options.threads;
    job.antialias = options.antialias;
    const bool linear = options.format == SampleFormat::linear16;
    const bool as_povray_writes_it = options.format == SampleFormat::srgb8 && view.film.plain();
    if (is_exr_name(options.output) || (!linear && !as_povray_writes_it)) {
        job.format = PovrayJob::Format::half;
        job.picture = "picture.exr";
    } else if (linear) {
        job.format = PovrayJob::Format::linear16;
    }
    if (options.on_progress)
        job.on_progress = [tell = options.on_progress](const PovrayProgress& progress) {
            tell({name_of(progress.stage), progress.fraction});
        };
    job.unconfined = options.unconfined;
    // POV-Ray's memory is estimated before; the limit is for errors of that.
    job.memory_bytes = 2 * options.compile.detail.memory_bytes + (1ull << 30);
    return job;
}

/// The C library keeps what it was given back; other programs cannot use that.
void return_free_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

/// Checks what would fail late, and writes the scene.
Status prepare(const CompiledModel& model, const RenderOptions& options, TextureStore& textures,
               TemporaryDirectory& temporary, const LightListSize& lights, PovrayJob& job) {
    Status status = povray_available(job.program);
    if (status.ok()) status = check_writable(options.output);
    if (status.ok()) status = choose_directory(options.keep, temporary, job.directory);
    if (status.ok())
        status = write_scene(model, job.directory + "/" + job.scene, {.progress = true, .lights = lights},
                             textures, job.cancel);
    return status;
}

/// Notes on light that POV-Ray's picture lacks.
void note_lacks(const CompiledModel& model, Diagnostics& diagnostics) {
    const Graph& graph = model.model->graph;
    const View& view = model.view;
    const Span span = graph.objects[graph.root].span;
    if (view.sky_light && view.sky_light->bounces > 0)
        diagnostics
            .note(span, "POV-Ray's picture has no light from surface to surface: each material's 'ambient' "
                        "stands for it")
            .with_hint("use '--engine native' to follow the 'bounces' of the sky");
    if (view.sun_of_haze())
        diagnostics.note(span, "POV-Ray's picture shows haze without the sun's shafts")
            .with_hint("use '--engine native' to draw the 'sun' of the haze");
    if (shows_blur(graph, view))
        diagnostics.note(span, "POV-Ray's picture shows all mirrors and glass sharp")
            .with_hint("use '--engine native' to draw the 'blur' of materials");
}

double work_of(const RenderOptions& options, Quality quality) {
    return options.work_seconds.value_or(povray_seconds(quality));
}

/// The lights that POV-Ray is to follow, and how many they are.
struct FollowedLights {
    LightListSize size;
    std::size_t count = 0;
};

/// Lights that POV-Ray can follow in these seconds, at most as soft as the quality asks. Fewer show their
/// number as bands in the shadows.
FollowedLights affordable_lights(const View& view, double seconds_a_light, double seconds,
                                 std::size_t asked_count) {
    constexpr LightListSize least{.disc = 2, .dome = 6, .area = 4};
    const LightListSize asked = list_size(view.quality);
    const double share = std::min(seconds / seconds_a_light / static_cast<double>(asked_count), 1.0);
    const auto part = [share](unsigned least_count, unsigned count) {
        return std::min(count, std::max(least_count, static_cast<unsigned>(share * count)));
    };
    const LightListSize size{.disc = part(least.disc, asked.disc),
                             .dome = part(least.dome, asked.dome),
                             .area = part(least.area, asked.area)};
    return {size, size == asked ? asked_count : listed_lights(view, size).size()};
}

/// The lights' share of the picture's work. POV-Ray's other rays, and unforeseen work, need the rest.
constexpr double share_for_lights = 0.5;

FollowedLights followed_lights(const CompiledModel& model, double seconds_a_light, double work_seconds,
                               Diagnostics& diagnostics) {
    const View& view = model.view;
    const LightListSize size = list_size(view.quality);
    const std::size_t asked = listed_lights(view, size).size();
    if (!view.has_soft_light()) return {size, asked};
    const FollowedLights lights =
        affordable_lights(view, seconds_a_light, share_for_lights * work_seconds, asked);
    if (lights.count == asked) return lights;
    const Graph& graph = model.model->graph;
    diagnostics
        .note(graph.objects[graph.root].span,
              fmt::format(
                  "POV-Ray takes soft light from {} lights in place of {}, to draw this picture in time",
                  lights.count, asked))
        .with_hint("--engine native follows soft light faster; a larger --work gives POV-Ray more lights");
    return lights;
}

/// Seconds of one processor that POV-Ray takes.
struct PovrayTime {
    double parsing = 0;
    double tracing = 0;

    double seconds() const { return parsing + tracing; }
};

/// Seconds for a light, by the boxes that rays meet. Scenes of random models took 0.01 to 0.4 microseconds
/// for a box, and those with shadows from outside the picture more.
double seconds_a_light(const PovrayJob& job, double overlap) {
    const double rays_a_pixel = job.antialias ? 1.5 * std::pow(4.0, *job.antialias - 1) : 1;
    // Measured under one sun: the way to each light is another ray.
    return 0.5 * rays_a_pixel * job.width * job.height * (1e-6 + 4e-7 * overlap);
}

PovrayTime guessed_time(const PovrayJob& job, double seconds_a_light, std::size_t lights) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(job.directory + "/" + job.scene, error);
    const double megabytes = error ? 0 : 1e-6 * static_cast<double>(bytes);
    return {0.05 * megabytes, seconds_a_light * (1 + static_cast<double>(lights))};
}

/// Measured on a picture of the same scene that has a four-hundredth of the pixels, or fewer where that might
/// take long too. Nothing if that fails.
std::optional<PovrayTime> tried_time(const PovrayJob& job, const PovrayTime& guessed) {
    constexpr double trial_seconds = 5;
    constexpr int least_px = 8;
    const double smaller = std::max(20.0, std::sqrt(guessed.tracing / trial_seconds));
    const auto fewer = [&](int px) {
        return std::min(px, std::max(least_px, static_cast<int>(px / smaller)));
    };
    PovrayJob trial = job;
    trial.width = fewer(job.width);
    trial.height = fewer(job.height);
    trial.threads = 1;
    trial.on_progress = {};
    const PovrayLog log = run_povray(trial).log;
    std::error_code error;
    std::filesystem::remove(job.directory + "/" + job.picture, error);
    if (!log.trace_seconds) return std::nullopt;
    constexpr double half_of_a_tick = 0.5e-3; // of POV-Ray's clock
    // Each row and column has one corner more than it has pixels.
    const auto corners = [](const PovrayJob& of) { return (of.width + 1.0) * (of.height + 1.0); };
    return PovrayTime{log.parse_seconds.value_or(0) + log.bounding_seconds.value_or(0),
                      (*log.trace_seconds + half_of_a_tick) * corners(job) / corners(trial)};
}

/// Where it costs a small part of the picture: a trial parses the whole text.
bool worth_a_trial(const PovrayTime& guessed, double work_seconds) {
    return guessed.seconds() > 0.25 * work_seconds && guessed.tracing > 2 * guessed.parsing;
}

std::string bytes_text(std::uint64_t bytes) {
    const double mib = static_cast<double>(bytes) / (1 << 20);
    return mib < 10'000 ? fmt::format("{:.0f} MiB", mib) : fmt::format("{:.1f} GiB", mib / 1024);
}

/// Whole numbers up to a million, then "4.7e+11".
std::string count_text(double count) {
    return count < 1e6 ? fmt::format("{:.0f}", count) : fmt::format("{:.2e}", count);
}

std::string primitives_text(const PovrayReport& report) {
    std::string text =
        fmt::format("{} primitives as {} placements", count_text(report.leaf_count), report.placement_count);
    if (report.triangle_count > 0) text += fmt::format(" of meshes with {} triangles", report.triangle_count);
    return text +
           (report.error_px > 0 ? fmt::format(", error {:.2g} px", report.error_px) : ", nothing left out");
}

} // namespace

constinit const Engine povray_engine = {
    .name = "povray",
    .summary = "POV-Ray 3.7",
    .available = []() -> Status { return povray_available(); },
    .refusal = [](const RenderOptions& options) -> std::string {
        if (options.tile)
            return "--tile needs '--engine native': POV-Ray smooths the edges of a part otherwise than those "
                   "of the whole";
        if (options.compile.view.transparent)
            return "--transparent needs '--engine native': POV-Ray's pictures have a background";
        if (options.aovs) return "--aovs needs '--engine native': POV-Ray gives colours only";
        return options.progressive
                   ? "--progressive needs '--engine native': POV-Ray shows nothing before its "
                     "picture is finished"
                   : "";
    },
    .compile = [](Session& session, const StageOptions& options, Compilation& compilation) -> bool {
        return session.prepared(options, compilation) != nullptr;
    },
    .draw = [](PictureSession& session, const RenderOptions& options,
               Compilation& compilation) -> std::optional<DrawReport> {
        const std::optional<PovrayReport> drawn = render_by_povray(session, options, compilation);
        if (!drawn) return std::nullopt;
        DrawReport report;
        report.summary = fmt::format("{}; POV-Ray {:.1f} s, peak {}, estimated {}", primitives_text(*drawn),
                                     drawn->povray_seconds, bytes_text(drawn->peak_bytes),
                                     bytes_text(drawn->estimated_bytes));
        report.error_px = drawn->error_px;
        return report;
    },
};

std::string cut_text(const Cut& cut) {
    return primitives_text(report_of(cut));
}

std::optional<PovrayReport> render_by_povray(PictureSession& session, const RenderOptions& options,
                                             Compilation& compilation) {
    std::shared_ptr<const CompiledModel> model =
        compile_scene(session, options.compile, compilation, options.cut);
    if (!model) return std::nullopt;
    TemporaryDirectory temporary;
    const Film film = model->view.film;
    PovrayJob job = job_for(options, model->view);
    job.cancel = session.control().cancel;
    const auto run = [&](const char* stage, const auto& work) {
        const Stopwatch watch;
        compilation.status = work();
        compilation.times.push_back({stage, watch.seconds()});
        return compilation.status.ok();
    };

    note_lacks(*model, compilation.diagnostics);
    const double light_seconds = seconds_a_light(job, mean_overlap(model->cut, model->view));
    const FollowedLights lights = followed_lights(
        *model, light_seconds, work_of(options, model->view.quality), compilation.diagnostics);
    // Where light is but roughly what it should be, edges need not be more exact.
    if (lights.size != list_size(model->view.quality)) job.antialias_threshold = 0.1;
    const auto emit = [&] {
        return prepare(*model, options, session.textures(), temporary, lights.size, job);
    };
    if (!run("emit", emit)) return std::nullopt;
    PovrayReport report = report_of(model->cut);
    count_objects(model->cut, job);
    model.reset(); // POV-Ray may need the memory
    session.yield_memory();
    return_free_memory();

    PovrayTime time = guessed_time(job, light_seconds, lights.count);
    const auto set_limit = [&] { // far more than any picture has taken
        job.cpu_seconds = static_cast<std::uint64_t>(600 + 50 * time.seconds());
    };
    set_limit();
    if (options.on_start) {
        if (worth_a_trial(time, options.compile.detail.work_seconds))
            time = tried_time(job, time).value_or(time);
        if (!job.cancel.raised())
            options.on_start({.seconds = time.seconds(), .whole_seconds = time.seconds(), .fewer = {}});
        set_limit();
    }
    const auto trace = [&] {
        const PovrayResult result = run_povray(job);
        report.peak_bytes = result.process.peak_bytes;
        report.povray_seconds = result.process.wall_seconds;
        return result.status;
    };
    if (!run("povray", trace)) return std::nullopt;
    if (!run("picture", [&] { return finish_picture(job, options, film, job.cancel); })) return std::nullopt;
    return report;
}

} // namespace graftal
