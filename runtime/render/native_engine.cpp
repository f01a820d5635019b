#include "runtime/render/native_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "compiler/session/stages.h"
#include "runtime/image/develop.h"
#include "runtime/render/aov_channels.h"
#include "runtime/render/fit_picture.h"
#include "runtime/render/samplings.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

std::string samples_in_words(const std::vector<Sampling>& samplings) {
    const double samples = samplings.back().samples_a_pixel();
    return samples > 1 ? fmt::format("{:.0f}", samples) : "one";
}

/// Of a picture with all samples that were asked for.
double seconds_as_asked(const FittedModel& fitted, const Looks& looks, ImageSize size) {
    return fitted.whole_seconds * samples_a_pixel(looks.wanted) / samples_a_pixel(looks.tried) +
           least_seconds(looks.wanted, size);
}

/// That have to be allowed for it.
double work_as_asked(const FittedModel& fitted, const Looks& looks, ImageSize size) {
    return std::max(seconds_as_asked(fitted, looks, size),
                    least_seconds(looks.wanted, size) / most_for_samples);
}

/// The picture that was asked for, for messages.
struct Asked {
    Span span; ///< of the model
    ImageSize size;
    std::uint64_t drawn_pixels; ///< of them
    const DetailOptions& detail;
};

/// Says what the work allowed has cost, or what a picture that leaves nothing out will take.
void report_work(const FittedModel& fitted, const Looks& looks, const Asked& asked,
                 Diagnostics& diagnostics) {
    const Span& span = asked.span;
    const double allowed = asked.detail.work_seconds;
    const double seconds = seconds_as_asked(fitted, looks, asked.size);
    if (fitted.out_of_memory)
        warn_of_limit(span, limit_of_memory(asked.detail.memory_bytes),
                      {fitted.error_px, asked.detail.error_px}, diagnostics);
    if (!asked.detail.culls()) {
        if (!(seconds > allowed)) return;
        diagnostics
            .note(span,
                  fmt::format(
                      "this picture takes about {} seconds of one processor, because nothing is left out",
                      readable_seconds(seconds)))
            .with_hint("use --error 0.5 to leave out invisible detail");
        return;
    }
    Limit limit = limit_of_work(allowed);
    limit.need = fmt::format("the picture as asked would take about {} seconds of one processor",
                             readable_seconds(work_as_asked(fitted, looks, asked.size)));
    const std::string samples = samples_in_words(looks.affordable);
    const std::string samples_with_noun = samples == "one" ? "one sample" : samples + " samples";
    if (!fitted.work_cut) {
        if (looks.fewer() && !(looks.wanted.back().noise_255 > 0)) // else see report_noise()
            diagnostics
                .warning(span, fmt::format("{} allow {} per pixel, not {}", limit.allowed, samples_with_noun,
                                           samples_in_words(looks.wanted)))
                .with_hint(limit.need + ": give them with " + limit.option +
                           ", or ask for fewer samples with --antialias");
        return;
    }
    if (fitted.rays_cut) limit.besides = ", and graftal gives up rays that meet too many parts";
    const int block = looks.affordable.back().block;
    if (block > 1)
        limit.besides += fmt::format(", one per {0} by {0} pixels", block);
    else if (looks.fewer())
        limit.besides += fitted.rays_cut ? fmt::format(", {} per pixel", samples)
                                         : fmt::format(", by {} per pixel", samples_with_noun);
    warn_of_limit(span, limit, {fitted.error_px, asked.detail.error_px}, diagnostics);
}

/// Says where the work allowed left more noise than was asked for; where nobody asked, only if that is much.
void report_noise(const TraceStatistics& rays, const Looks& looks, const Asked& asked, bool by_default,
                  Diagnostics& diagnostics) {
    const double noticed = by_default ? 0.25 : 0.01; // of the picture
    const double share = static_cast<double>(rays.noisy_pixels) / static_cast<double>(asked.drawn_pixels);
    if (!looks.fewer() || !(share > noticed)) return;
    const Limit limit = limit_of_work(asked.detail.work_seconds);
    diagnostics
        .warning(asked.span,
                 fmt::format("{} allow {} samples per pixel: in {:.0f} % of the picture the noise is above "
                             "{:g} of 255 steps",
                             limit.allowed, samples_in_words(looks.affordable), 100 * share,
                             looks.wanted.back().noise_255))
        .with_hint(fmt::format("allow more with {}, or ask for less with --quality, --noise or --size",
                               limit.option));
}

/// Says what a picture takes that is too large even for one sample a pixel.
void report_size(const Looks& looks, const Asked& asked, Diagnostics& diagnostics) {
    const double seconds = least_seconds(looks.affordable, asked.size);
    if (!asked.detail.culls() || !(seconds > asked.detail.work_seconds)) return;
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
        warn_of_shells(asked.span, {coarsest * model.options.error_px, asked.detail.error_px}, diagnostics);
}

/// What of the picture is drawn.
Tile window_of(const RenderOptions& options, ImageSize size) {
    return options.tile.value_or(whole_of(size));
}

/// One picture, from the first sample to the last file.
class Drawing {
  public:
    Drawing(const View& view, const CutGraph& cut, const RenderOptions& options, const PictureSink& sink,
            const CancelFlag& cancel)
        : options_(options), sink_(sink), cancel_(cancel), window_(window_of(options, view.size)),
          film_(view.film) {
        picture_.width = window_.width;
        picture_.height = window_.height;
        picture_.channels = 3;
        picture_.pixels.resize(3 * pixels());
        if (!options.aovs) return;
        aovs_.resize(pixels());
        numbers_.emplace(cut);
    }

    /// One look after the other. `work`: samples a pixel of all looks, earlier and later ones too.
    Status run(const TraceModel& model, const std::vector<Sampling>& samplings, double work) {
        work_ = work;
        PictureTracer tracer(model, limits_of(model, options_));
        const Status status = run(tracer, samplings);
        report_.rays += tracer.statistics();
        return status;
    }

    double done() const { return done_; } ///< samples a pixel

    const NativeReport& report() const { return report_; }

  private:
    Status run(PictureTracer& tracer, const std::vector<Sampling>& samplings) {
        report_.finished = false;
        for (const Sampling& sampling : samplings) {
            const std::size_t traced = trace(tracer, sampling);
            const bool complete = traced == pixels();
            if (!complete && !worth_leaving()) return interrupted();
            const Status status = write();
            if (!status.ok()) return status;
            note(sampling, traced);
            if (!complete) return interrupted();
        }
        report_.finished = true;
        return {};
    }

    std::size_t pixels() const { return window_.pixels(); }

    static Status interrupted() { return Status::failure("interrupted"); }

    /// A picture that is cut short is finer than the one that is there.
    bool worth_leaving() const { return options_.progressive && report_.pictures > 0; }

    void note(const Sampling& sampling, std::size_t traced) {
        if (traced == pixels()) {
            report_.samples_a_pixel = sampling.samples_a_pixel();
            report_.fewer_where_calm = sampling.noise_255 > 0;
            return;
        }
        report_.finer_samples_a_pixel = sampling.samples_a_pixel();
        report_.finer_share = static_cast<double>(traced) / static_cast<double>(pixels());
    }

    /// Returns the number of finished pixels: all, unless it was interrupted.
    std::size_t trace(PictureTracer& tracer, const Sampling& sampling) {
        const Stopwatch watch;
        std::size_t traced = 0;
        TraceControl control;
        control.threads = options_.threads;
        control.sequence = options_.sequence;
        control.cancelled = [this] { return cancel_.raised(); };
        control.on_tile = [&](const Tile& tile) {
            traced += tile.pixels();
            const double share = static_cast<double>(traced) / static_cast<double>(pixels());
            tell((done_ + share * sampling.samples_a_pixel()) / work_);
        };
        tracer.trace(sampling, control, window_, picture_, numbers_ ? &aovs_ : nullptr);
        done_ += sampling.samples_a_pixel();
        report_.seconds += watch.seconds();
        return traced;
    }

    void tell(double fraction) const {
        if (options_.on_progress) options_.on_progress({report_.pictures ? "refining" : "tracing", fraction});
    }

    Status write() {
        const RenderOptions& render = options_;
        const bool linear = render.format == SampleFormat::linear16 || is_exr_name(render.output);
        const Image image = linear ? picture_ : encoded();
        MoreChannels more;
        if (numbers_) more = aov_channels(aovs_, *numbers_);
        const Status status = sink_ ? sink_(image)
                                    : write_image(render.output, image, render.format, render.metadata,
                                                  numbers_ ? &more : nullptr);
        if (status.ok() && report_.pictures++ == 0) report_.first_picture_seconds = watch_.seconds();
        return status;
    }

    Image encoded() const {
        Image image = picture_;
        constexpr int rows = 16;
        const Developer developer(film_, options_.format, window_.x, window_.y);
        const auto encode = [&](int, std::uint64_t piece) {
            const int begin = static_cast<int>(piece) * rows;
            developer.develop(image, begin, std::min(begin + rows, image.height));
        };
        WorkerThreads(options_.threads)
            .for_each(static_cast<std::uint64_t>((image.height + rows - 1) / rows), encode);
        return image;
    }

    const RenderOptions& options_;
    const PictureSink& sink_;
    const CancelFlag& cancel_;
    Tile window_; ///< of the picture
    Film film_;
    Image picture_;
    AovPicture aovs_;
    std::optional<ObjectNumbers> numbers_; ///< if there are AOVs
    NativeReport report_;
    Stopwatch watch_;
    double work_ = 0, done_ = 0; ///< samples a pixel
};

/// The first of progressive pictures, before anything is known but what a few rays took: so coarse that it is
/// soon there. Nothing if that is not so.
std::optional<Sampling> first_draft(const TraceModel& model, const Sampling& first, double seconds_a_sample) {
    constexpr double soon = 0.05, too_late = 1; // seconds of one processor
    if (model.has_shells) return std::nullopt;  // to make them takes time that nobody knows
    const Sampling draft = draft_before(first, seconds_a_sample, soon).value_or(first);
    return draft.samples_a_pixel() * seconds_a_sample < too_late ? std::optional(draft) : std::nullopt;
}

/// "4 samples per pixel", "1 sample per pixel", "1 sample per 8x8 pixels"
std::string samples_text(double a_pixel) {
    if (a_pixel > 0 && a_pixel < 1) {
        const double block = std::round(std::sqrt(1 / a_pixel));
        return fmt::format("1 sample per {0:g}x{0:g} pixels", block);
    }
    return fmt::format("{:g} sample{} per pixel", a_pixel, a_pixel == 1 ? "" : "s");
}

std::string in_words(const NativeReport& report) {
    std::string text = report.finished ? "" : "unfinished: ";
    if (report.fewer_where_calm) text += "up to ";
    text += samples_text(report.samples_a_pixel);
    if (report.finer_share > 0)
        text += fmt::format(", in {:.2g} % of the picture {},", 100 * report.finer_share,
                            samples_text(report.finer_samples_a_pixel));
    text += fmt::format(" in {:.2f} s, {}", report.seconds, rays_text(report.rays, report.seconds));
    if (report.pictures > 1)
        text += fmt::format("; the first of {} pictures after {:.2f} s", report.pictures,
                            report.first_picture_seconds);
    return text;
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

/// As trace_model(), by a fit that is known: whoever found it has said what the work has cost.
std::optional<NativeReport> trace_fitted(const PreparedView& prepared, const RenderOptions& options,
                                         const Stopwatch& preparing, const CancelFlag& cancel,
                                         Compilation& compilation, const PictureSink& sink) {
    const PicturePlan plan = plan_picture(prepared, options);
    const std::unique_ptr<TraceModel> model = model_of(*options.fit, prepared, plan.detail);
    Drawing drawing(prepared.viewed->view, prepared.prepared->cut, options, sink, cancel);
    compilation.times.push_back({"prepare", preparing.seconds()});
    const Stopwatch drawing_watch;
    const Sampling& sampling = options.fit->sampling;
    compilation.status = drawing.run(*model, {sampling}, sampling.samples_a_pixel());
    compilation.times.push_back({"trace", drawing_watch.seconds()});
    if (!compilation.status.ok()) return std::nullopt;
    return drawing.report();
}

} // namespace

constinit const Engine native_engine = {
    .name = "native",
    .summary = "graftal's own ray tracer",
    .available = []() -> Status { return {}; },
    // What it does anyhow is fine: it has no POV-Ray to take --memory, and it goes into every part, as
    // --flatten wants it.
    .refusal = [](const RenderOptions& options) -> std::string {
        if (options.aovs && !is_exr_name(options.output))
            return "--aovs: only an EXR has room for more channels: name the picture with '-o FILE.exr'";
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
        if (!drawn) return std::nullopt;
        DrawReport report;
        report.summary = in_words(*drawn);
        report.rays = drawn->rays;
        report.trace_seconds = drawn->seconds;
        return report;
    },
};

std::optional<NativeReport> render_natively(PictureSession& session, const RenderOptions& options,
                                            Compilation& compilation, const PictureSink& sink) {
    const Stopwatch whole;
    const StageOptions stages = stages_of(options);
    PreparedView model;
    if (!view_model(session, stages, model, compilation)) return std::nullopt;
    if (!sink) compilation.status = check_writable(options.output);
    if (!compilation.status.ok()) return std::nullopt;

    const Stopwatch preparing;
    const double before = whole.seconds();
    if (!prepare_model(session, stages, model, compilation)) return std::nullopt;
    std::optional<NativeReport> report =
        trace_model(model, options, preparing, session.control().cancel, compilation, sink);
    if (report) report->first_picture_seconds += before;
    return report;
}

std::optional<NativeReport> trace_model(const PreparedView& prepared, const RenderOptions& options,
                                        const Stopwatch& preparing, const CancelFlag& cancel,
                                        Compilation& compilation, const PictureSink& sink) {
    const Graph& graph = prepared.viewed->model->graph;
    const View& view = prepared.viewed->view;
    if (options.fit) return trace_fitted(prepared, options, preparing, cancel, compilation, sink);
    PicturePlan plan = plan_picture(prepared, options);
    const DetailOptions& detail = plan.detail;
    const Looks& looks = plan.looks;
    const double samples = samples_a_pixel(looks.tried);
    const double least_a_sample = least_seconds({{.block = 1}}, view.size);
    Drawing drawing(view, prepared.prepared->cut, options, sink, cancel);
    const double seconds_before = preparing.seconds();
    std::optional<Sampling> draft;
    const auto draw_draft = [&](const TraceModel& tried, double seconds) {
        draft = first_draft(tried, looks.wanted.front(), seconds / samples + least_a_sample);
        if (!draft) return;
        compilation.status = drawing.run(tried, {*draft}, samples_a_pixel(looks.wanted));
    };
    std::function<void(const TraceModel&, double)> on_first_look;
    if (options.progressive) on_first_look = draw_draft;
    const FittedModel fitted = fit_picture(
        prepared, options, [&] { return cancel.raised() || !compilation.status.ok(); }, on_first_look, plan);
    if (!compilation.status.ok() && !cancel.raised()) return std::nullopt;
    const TraceModel& model = *fitted.model;
    const Asked asked{graph.objects[graph.root].span, view.size, window_of(options, view.size).pixels(),
                      detail};
    report_work(fitted, looks, asked, compilation.diagnostics);
    report_size(looks, asked, compilation.diagnostics);
    compilation.times.push_back({"prepare", preparing.seconds()});
    if (detail.culls() && !detail.steps) note_shadowless(model.prepared.cut, graph, compilation.diagnostics);
    std::vector<Sampling> samplings = looks.affordable;
    if (draft && samplings.size() > 1 && samplings.front().block == draft->block)
        samplings.erase(samplings.begin());
    if (options.draft_seconds && !draft) {
        const double seconds_a_sample = fitted.seconds / samples + least_a_sample;
        if (const auto before = draft_before(samplings.front(), seconds_a_sample, *options.draft_seconds))
            samplings.insert(samplings.begin(), *before);
    }
    const Stopwatch drawing_watch;
    compilation.status = drawing.run(model, samplings, drawing.done() + samples_a_pixel(samplings));
    compilation.times.push_back({"trace", drawing_watch.seconds()});
    report_shells(model, asked, compilation.diagnostics);
    NativeReport report = drawing.report();
    const bool by_default = !options.samples && !options.noise_255 && view.quality == Quality::normal;
    report_noise(report.rays, looks, asked, by_default, compilation.diagnostics);
    report.first_picture_seconds += seconds_before;
    if (!compilation.status.ok() && report.pictures == 0) return std::nullopt;
    return report;
}

std::optional<PictureFit> fit_natively(PictureSession& session, const RenderOptions& options,
                                       Compilation& compilation) {
    const StageOptions stages = stages_of(options);
    PreparedView model;
    if (!view_model(session, stages, model, compilation) ||
        !prepare_model(session, stages, model, compilation))
        return std::nullopt;
    const CancelFlag cancel = session.control().cancel;
    PicturePlan plan = plan_picture(model, options);
    const FittedModel fitted = fit_picture(
        model, options, [&] { return cancel.raised(); }, {}, plan);
    if (cancel.raised()) {
        compilation.status = Status::failure("interrupted");
        return std::nullopt;
    }
    const Graph& graph = model.viewed->model->graph;
    const ImageSize size = model.viewed->view.size;
    const Asked asked{graph.objects[graph.root].span, size, whole_of(size).pixels(), plan.detail};
    report_work(fitted, plan.looks, asked, compilation.diagnostics);
    report_size(plan.looks, asked, compilation.diagnostics);
    PictureFit fit = fit_of(fitted, plan, size);
    fit.size = size;
    return fit;
}

} // namespace graftal
