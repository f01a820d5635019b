#include "runtime/render/native_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "compiler/detail/work.h"
#include "compiler/session/stages.h"
#include "runtime/fit/fit_picture.h"
#include "runtime/fit/samplings.h"
#include "runtime/render/drawing.h"
#include "runtime/render/file_film.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

/// The picture that was asked for, for messages.
struct Asked {
    Span span; ///< of the model
    ImageSize size;
    std::uint64_t drawn_pixels; ///< of them
    const PicturePlan& plan;
    bool by_default; ///< nobody has named the work, or the samples
};

/// "4 samples per pixel", "1 sample per pixel", "1 sample per 8x8 pixels"
std::string samples_text(double a_pixel) {
    if (a_pixel > 0 && a_pixel < 1) {
        if (a_pixel == 0.5) return "1 sample per 2 pixels";
        const double block = std::round(std::sqrt(1 / a_pixel));
        return fmt::format("1 sample per {0:g}x{0:g} pixels", block);
    }
    return fmt::format("{:g} sample{} per pixel", a_pixel, a_pixel == 1 ? "" : "s");
}

std::string samples_text(const Sampling& sampling) {
    return samples_text(sampling.samples_a_pixel());
}

/// The limit of the work, with what the picture as it was asked for needs.
Limit limit_for(const FittedModel& fitted, const DetailOptions& detail) {
    Limit limit = limit_of_work(detail.work_seconds);
    limit.need = fmt::format("the picture as asked would take about {} seconds of one processor",
                             readable_seconds(fitted.whole_seconds));
    return limit;
}

/// Says what the work allowed has cost, or what a picture that leaves nothing out will take.
void report_work(const FittedModel& fitted, const Asked& asked, Diagnostics& diagnostics) {
    const DetailOptions& detail = asked.plan.detail;
    const Sampling& wanted = asked.plan.wanted;
    const CoarserError error{fitted.error_px, detail.error_px};
    if (fitted.out_of_memory)
        warn_of_limit(asked.span, limit_of_memory(detail.memory_bytes), error, diagnostics);
    if (!detail.culls()) {
        if (!(fitted.whole_seconds > detail.work_seconds)) return;
        diagnostics
            .note(asked.span,
                  fmt::format(
                      "this picture takes about {} seconds of one processor, because nothing is left out",
                      readable_seconds(fitted.whole_seconds)))
            .with_hint("use '--error 0.5' to leave out invisible detail");
        return;
    }
    Limit limit = limit_for(fitted, detail);
    const bool fewer = fitted.sampling != wanted;
    if (fitted.rays_cut) limit.besides = ", and graftal gives up rays that meet too many parts";
    if (fewer) limit.besides += fmt::format(", by {}", samples_text(fitted.sampling));
    if (fitted.rays_cut || error.px > error.asked_px) {
        warn_of_limit(asked.span, limit, error, diagnostics);
        return;
    }
    // Users who ask for nothing learn it before the picture starts (on_start); for noise see report_noise().
    if (!fewer || asked.by_default || wanted.noise_255 > 0) return;
    diagnostics
        .warning(asked.span, fmt::format("{} allow {}, not {:g}", limit.allowed,
                                         samples_text(fitted.sampling), wanted.samples_a_pixel()))
        .with_hint(limit.need + ": give them with " + limit.option +
                   ", or ask for fewer samples with --antialias");
}

/// Says where the work that somebody allowed left more noise than was asked for.
void report_noise(const TraceStatistics& rays, const FittedModel& fitted, const Asked& asked,
                  Diagnostics& diagnostics) {
    constexpr double noticed = 0.01; // of the picture
    const double share = static_cast<double>(rays.noisy_pixels) / static_cast<double>(asked.drawn_pixels);
    if (asked.by_default || fitted.sampling == asked.plan.wanted || !(share > noticed)) return;
    const Limit limit = limit_of_work(asked.plan.detail.work_seconds);
    diagnostics
        .warning(asked.span,
                 fmt::format("{} allow {}: in {:.0f} % of the picture the noise is above {:g} of 255 steps",
                             limit.allowed, samples_text(fitted.sampling), 100 * share,
                             asked.plan.wanted.noise_255))
        .with_hint(fmt::format("allow more with {}, or ask for less with --quality, --noise or --size",
                               limit.option));
}

/// Says what a picture takes that is too large even for one sample a pixel.
void report_size(const FittedModel& fitted, const Asked& asked, Diagnostics& diagnostics) {
    const double seconds = least_seconds(fitted.sampling, asked.size);
    if (!asked.plan.detail.culls() || !(seconds > asked.plan.detail.work_seconds)) return;
    diagnostics
        .note(asked.span, fmt::format("a picture of this size takes at least {} seconds of one processor",
                                      readable_seconds(seconds)))
        .with_hint("choose a smaller picture with --size");
}

/// Says how coarse the shells had to be.
void report_shells(const TraceModel& model, const Asked& asked, Diagnostics& diagnostics) {
    constexpr double step_of_details = 1.5; // a shell serves sizes of half an octave
    const double coarsest = model.meshes.coarsest_shell();
    if (coarsest > step_of_details)
        warn_of_shells(asked.span, {coarsest * model.options.error_px, asked.plan.detail.error_px},
                       diagnostics);
}

/// The first of progressive pictures, before anything is known but what a few rays took: so coarse that it is
/// soon there.
struct Draft {
    std::vector<Sampling> looks;       ///< one, or none where the finest look is there as soon
    std::unique_ptr<TraceModel> rough; ///< to look at in place of the model, if that might take long
};

Draft first_draft(const TraceModel& model, const Sampling& finest, double sample_seconds) {
    constexpr double soon = 0.05, too_late = 0.3; // seconds of one processor
    // Errors grow to half of the widest block, and on where finer ones mean more and larger shells.
    constexpr double coarser_parts = 8, coarser_shells = 64;
    constexpr double share_for_shells = 0.1; // of the work
    constexpr std::uint64_t most_visits = 1024;
    Draft draft{looks_before(finest, sample_seconds, soon), nullptr};
    if (draft.looks.empty()) return draft;
    draft.looks.resize(1);
    const bool is_late = draft.looks.front().samples_a_pixel() * sample_seconds > too_late;
    // Nobody knows how many shells its rays will meet, and they belong to the price of the model itself.
    if (!model.options.culls() || !(is_late || model.has_shells)) return draft;
    DetailOptions options = model.options;
    const double coarser = model.has_shells ? coarser_shells : coarser_parts;
    options.error_px *= coarser;
    if (options.error_world) *options.error_world *= coarser;
    draft.rough =
        std::make_unique<TraceModel>(model.shared, model.view, options, model.textures, model.basis);
    draft.rough->most_visits = std::min(model.most_visits, most_visits);
    // Nothing takes this look from the work of the picture: beyond a share of it, shells are left out.
    draft.rough->meshes.make_until(
        static_cast<std::uint64_t>(share_for_shells * options.work_seconds * WorkRates::shell_points));
    return draft;
}

std::string in_words(const NativeReport& report, std::string_view device) {
    std::string text = report.finished ? "" : "unfinished: ";
    if (report.fewer_where_calm) text += "up to ";
    text += samples_text(report.samples_a_pixel);
    if (report.finer_share > 0)
        text += fmt::format(", in {:.2g} % of the picture {}", 100 * report.finer_share,
                            samples_text(report.finer_samples_a_pixel));
    if (report.error_px > 0) text += fmt::format(", error {:.3g} px", report.error_px);
    if (const std::optional<double> noise = report.rays.noise_255())
        text += fmt::format(", noise {:.2g} of 255", *noise);
    if (report.no_room_to_denoise) text += " (there was no memory to denoise it)";
    text += device.empty() ? fmt::format(" in {:.2f} s", report.whole_seconds)
                           : fmt::format(" in {:.3g} s on {}", report.seconds, device);
    text += fmt::format(", {}", rays_text(report.rays, report.seconds));
    if (report.pictures > 1)
        text += fmt::format("; the first of {} pictures after {:.2f} s", report.pictures,
                            report.first_picture_seconds);
    return text;
}

/// The start of a picture, with what it will take. A lack that somebody asked for is a warning
/// (report_work()).
DrawStart start_of(const FittedModel& fitted, const PicturePlan& plan, bool by_default) {
    DrawStart start{fitted.seconds, fitted.whole_seconds, {}};
    if (by_default && fitted.sampling != plan.wanted)
        start.fewer = fmt::format("{} of {:g}", samples_text(fitted.sampling), plan.wanted.samples_a_pixel());
    return start;
}

StageOptions stages_of(const RenderOptions& options) {
    StageOptions stages = options.compile;
    stages.detail.keeps_objects = options.aovs;
    return stages;
}

bool view_model(PictureSession& session, const StageOptions& stages, PreparedView& model,
                Compilation& compilation) {
    model.viewed = session.viewed(stages, compilation);
    if (!model.viewed) return false;
    compilation.status = load_textures(model.viewed->model->graph.materials, model.viewed->view,
                                       session.textures(), model.textures);
    return compilation.status.ok();
}

bool prepare_model(PictureSession& session, const StageOptions& stages, PreparedView& model,
                   Compilation& compilation) {
    model.detail = resolved(stages.detail, *model.viewed);
    model.prepared = session.prepared(stages, compilation);
    return model.prepared != nullptr;
}

/// trace_model() by a known fit: the program that found it has said what the work has cost.
std::optional<NativeReport> trace_fitted(const PreparedView& prepared, const RenderOptions& options,
                                         const Stopwatch& preparing, const CancelFlag& cancel,
                                         Compilation& compilation) {
    const PicturePlan plan = plan_picture(prepared, options);
    const std::unique_ptr<TraceModel> model = model_of(*options.fit, prepared, plan.detail);
    FileFilm file(options);
    Drawing drawing(prepared, options, options.film ? *options.film : file, cancel);
    compilation.times.push_back({"prepare", preparing.seconds()});
    const Stopwatch drawing_watch;
    const Sampling& sampling = options.fit->sampling;
    compilation.status = drawing.finish(*model, sampling, 0);
    compilation.times.push_back({"trace", drawing_watch.seconds()});
    if (!compilation.status.ok()) return std::nullopt;
    return drawing.report();
}

} // namespace

constinit const Engine native_engine = {
    .name = "native",
    .summary = "graftal's own ray tracer",
    .progressive = true,
    .available = []() -> Status { return {}; },
    // Two options are fine, since it acts so anyhow: it has no POV-Ray to take --memory, and it goes into
    // every part, as --flatten wants it.
    .refusal = [](const RenderOptions& options) -> std::string {
        if (options.aovs && !is_exr_name(options.output))
            return "--aovs: only an EXR has room for more channels: name the picture with '-o FILE.exr'";
        if (options.tile && options.denoise.value_or(false))
            return "--denoise: a part of a picture lacks its neighbours: leave it out, or draw the whole";
        if (!options.keep.empty())
            return "--keep: the native engine writes no scene; leave out --keep, or give '--engine povray'";
        if (options.compile.detail.visible_only)
            return "--visible-only: the native engine follows every ray and so draws all shadows; leave out "
                   "--visible-only, or give '--engine povray'";
        return {};
    },
    .compile = [](Session& session, const StageOptions& options, Compilation& compilation) -> bool {
        return session.viewed(options, compilation) != nullptr;
    },
    .draw = [](PictureSession& session, const RenderOptions& options,
               Compilation& compilation) -> std::optional<DrawReport> {
        const std::optional<NativeReport> drawn = render_natively(session, options, compilation);
        return drawn ? std::optional(report_of(*drawn)) : std::nullopt;
    },
};

Status load_textures(const std::vector<Material>& materials, const View& view, TextureStore& store,
                     ModelTextures& textures) {
    Status status;
    const auto texture_of = [&](const Material& material) {
        return material.texture.empty() || !status.ok() ? nullptr : store.load(material.texture, status);
    };
    for (const Material& material : materials)
        textures.of_material.push_back(texture_of(material));
    if (view.ground) textures.of_ground = texture_of(view.ground->material);
    return status;
}

DrawReport report_of(const NativeReport& drawn, std::string_view device) {
    DrawReport report;
    report.summary = in_words(drawn, device);
    report.rays = drawn.rays;
    report.trace_seconds = drawn.seconds;
    return report;
}

bool prepare_view(PictureSession& session, const RenderOptions& options, PreparedView& model,
                  Compilation& compilation) {
    const StageOptions stages = stages_of(options);
    return view_model(session, stages, model, compilation) &&
           prepare_model(session, stages, model, compilation);
}

std::optional<NativeReport> render_natively(PictureSession& session, const RenderOptions& options,
                                            Compilation& compilation) {
    const Stopwatch whole;
    const StageOptions stages = stages_of(options);
    PreparedView model;
    if (!view_model(session, stages, model, compilation)) return std::nullopt;
    if (!options.film) compilation.status = check_writable(options.output);
    if (!compilation.status.ok()) return std::nullopt;

    const Stopwatch preparing;
    const double before = whole.seconds();
    if (!prepare_model(session, stages, model, compilation)) return std::nullopt;
    std::optional<NativeReport> report =
        trace_model(model, options, preparing, session.control().cancel, compilation);
    if (report) {
        report->first_picture_seconds += options.seconds_before + before;
        report->whole_seconds = options.seconds_before + whole.seconds();
    }
    return report;
}

std::optional<NativeReport> trace_model(const PreparedView& prepared, const RenderOptions& options,
                                        const Stopwatch& preparing, const CancelFlag& cancel,
                                        Compilation& compilation) {
    const Graph& graph = prepared.viewed->model->graph;
    const View& view = prepared.viewed->view;
    if (options.fit) return trace_fitted(prepared, options, preparing, cancel, compilation);
    PicturePlan plan = plan_picture(prepared, options);
    // The edges of a part would differ from those of the whole. Coverage and mattes, which are never
    // denoised, must fit the light.
    if (options.tile || (options.needs_aovs() && !options.denoise)) plan.wanted.denoise = false;
    FileFilm file(options);
    Drawing drawing(prepared, options, options.film ? *options.film : file, cancel);
    const double seconds_before = preparing.seconds();
    int draft_block = 0;
    std::function<void(const TraceModel&, double)> on_first_look;
    if (options.progressive)
        on_first_look = [&](const TraceModel& tried, double sample_seconds) {
            const Draft draft = first_draft(tried, plan.wanted, sample_seconds);
            if (draft.looks.empty()) return;
            draft_block = draft.looks.front().block;
            compilation.status =
                drawing.look(draft.rough ? *draft.rough : tried, draft.looks, plan.wanted.samples_a_pixel());
        };
    const std::optional<FittedModel> fit = fit_picture(
        prepared, options, plan, WorkerThreads(options.threads),
        [&] { return cancel.raised() || !compilation.status.ok(); }, on_first_look);
    if (!fit) { // pictures of its first looks stay
        if (compilation.status.ok()) compilation.status = Status::failure("interrupted");
        NativeReport report = drawing.report();
        report.first_picture_seconds += seconds_before;
        return cancel.raised() && report.pictures > 0 ? std::optional(report) : std::nullopt;
    }
    const FittedModel& fitted = *fit;
    const TraceModel& model = *fitted.model;
    const Asked asked{graph.objects[graph.root].span, view.size, window_of(options, view.size).pixels(), plan,
                      options.is_by_default(view.quality)};
    report_work(fitted, asked, compilation.diagnostics);
    report_size(fitted, asked, compilation.diagnostics);
    compilation.times.push_back({"prepare", preparing.seconds()});
    if (plan.detail.culls() && !plan.detail.steps)
        note_shadowless(model.prepared.cut, graph, compilation.diagnostics);
    if (options.on_start && !cancel.raised()) options.on_start(start_of(fitted, plan, asked.by_default));
    const Stopwatch drawing_watch;
    constexpr double soon = 0.3; // seconds of one processor
    if (options.progressive) {
        std::vector<Sampling> looks = looks_before(fitted.sampling, fitted.sample_seconds, soon);
        std::erase_if(looks,
                      [&](const Sampling& look) { return draft_block > 0 && look.block >= draft_block; });
        compilation.status = drawing.look(model, looks, drawing.done() + fitted.sampling.samples_a_pixel());
    }
    if (compilation.status.ok())
        compilation.status = drawing.finish(model, fitted.sampling, fitted.sample_seconds);
    compilation.times.push_back({"trace", drawing_watch.seconds()});
    report_shells(model, asked, compilation.diagnostics);
    NativeReport report = drawing.report();
    report_noise(report.rays, fitted, asked, compilation.diagnostics);
    report.first_picture_seconds += seconds_before;
    if (!compilation.status.ok() && report.pictures == 0) return std::nullopt;
    return report;
}

std::optional<PictureFit> fit_natively(PictureSession& session, const RenderOptions& options,
                                       Compilation& compilation) {
    PreparedView model;
    if (!prepare_view(session, options, model, compilation)) return std::nullopt;
    const CancelFlag cancel = session.control().cancel;
    PicturePlan plan = plan_picture(model, options);
    plan.wanted.denoise = false; // the picture is drawn in parts
    const std::optional<FittedModel> fitted =
        fit_picture(model, options, plan, WorkerThreads(options.threads), [&] { return cancel.raised(); });
    if (!fitted) {
        compilation.status = Status::failure("interrupted");
        return std::nullopt;
    }
    const Graph& graph = model.viewed->model->graph;
    const ImageSize size = model.viewed->view.size;
    const Asked asked{graph.objects[graph.root].span, size, whole_of(size).pixels(), plan,
                      options.is_by_default(model.viewed->view.quality)};
    report_work(*fitted, asked, compilation.diagnostics);
    report_size(*fitted, asked, compilation.diagnostics);
    return fit_of(*fitted, size);
}

} // namespace graftal
