#include "runtime/render/drawing.h"

#include <algorithm>
#include <cmath>

#include "runtime/fit/fit_picture.h"
#include "runtime/system/worker_threads.h"
#include "runtime/trace/denoise.h"

namespace graftal {

namespace {

/// Samples that are added between two pictures: the first round takes so many seconds of one processor.
constexpr double seconds_a_round = 2, growth_of_rounds = 3;

Status interrupted() {
    return Status::failure("interrupted");
}

} // namespace

Tile window_of(const RenderOptions& options, ImageSize size) {
    return options.tile.value_or(whole_of(size));
}

Drawing::Drawing(const PreparedView& prepared, const RenderOptions& options, PictureFilm& film,
                 const CancelFlag& cancel)
    : options_(options), film_(film), cancel_(cancel),
      window_(window_of(options, prepared.viewed->view.size)) {
    picture_.width = window_.width;
    picture_.height = window_.height;
    picture_.channels = 3;
    picture_.pixels.resize(3 * pixels());
    if (options.needs_aovs()) aovs_ = AovPicture(pixels(), options.aovs);
    film.begin({window_, picture_.channels, prepared.viewed->view, prepared.prepared->cut});
}

Status Drawing::look(const TraceModel& model, const std::vector<Sampling>& looks, double work) {
    work_ = work;
    report_.finished = false;
    for (const Sampling& sampling : looks)
        if (Status status = look(model, sampling); !status.ok()) return status;
    return {};
}

Status Drawing::finish(const TraceModel& model, const Sampling& finest, double sample_seconds) {
    work_ = done_ + finest.samples_a_pixel();
    report_.finished = false;
    std::vector<NoiseMeter> meters;
    const bool goes_on = options_.progressive && !options_.needs_aovs();
    if (finest.most_samples > 0 && (goes_on || finest.denoise) && has_room_for_samples()) {
        meters.resize(pixels());
        samples_ = &meters;
    }
    if (goes_on && samples_) {
        Sampling round = finest;
        const double soon = std::max(1.0, std::ceil(seconds_a_round / std::max(sample_seconds, 1e-9)));
        for (double count = soon; 2 * count < finest.most_samples; count *= growth_of_rounds) {
            round.most_samples = static_cast<int>(count);
            if (Status status = look(model, round); !status.ok()) return status;
        }
    }
    Status status = look(model, finest, true);
    report_.no_room_to_denoise = finest.denoise && !samples_;
    report_.finished = status.ok();
    return status;
}

Status Drawing::look(const TraceModel& model, const Sampling& sampling, bool last) {
    PictureTracer tracer(model, limits_of(model.prepared, model.view, options_));
    const std::size_t traced = trace(tracer, sampling);
    // The noise is that of the last look alone.
    report_.rays.noisy_pixels = report_.rays.noise_1024 = report_.rays.measured_pixels = 0;
    report_.rays += tracer.statistics();
    report_.error_px = model.options.culls() ? model.projection.error_px() : 0;
    const bool complete = traced == pixels();
    if (!complete && !worth_leaving()) return interrupted();
    if (complete && last && samples_ && sampling.feature_rays() > 0 &&
        !denoise(tracer, sampling, model.view.film))
        return interrupted();
    const Status status = film_.end(pass_++, picture_, aovs());
    if (!status.ok()) return status;
    if (report_.pictures++ == 0) report_.first_picture_seconds = watch_.seconds();
    note(sampling, traced);
    return complete ? status : interrupted();
}

/// Takes the noise out of the picture. False if it was cancelled.
bool Drawing::denoise(PictureTracer& tracer, const Sampling& sampling, const Film& film) {
    const WorkerThreads workers(options_.threads);
    std::vector<PixelFeatures> features(pixels());
    if (!tracer.trace_features(sampling.feature_rays(), control_by(workers), window_, features)) return false;
    Denoised denoised =
        graftal::denoise(*samples_, features, window_.width, window_.height, film, workers, cancel_);
    if (cancel_.raised()) return false;
    picture_ = std::move(denoised.picture);
    TraceStatistics& rays = report_.rays;
    rays.noisy_pixels = rays.noise_1024 = 0;
    rays.measured_pixels = pixels();
    for (const float error : denoised.errors_255) {
        rays.noise_1024 += static_cast<std::uint64_t>(std::llround(1024 * error));
        if (sampling.noise_255 > 0 && error > sampling.noise_255) ++rays.noisy_pixels;
    }
    return true;
}

bool Drawing::has_room_for_samples() const {
    constexpr std::uint64_t share = 4; // of the memory
    return pixels() * (sizeof(NoiseMeter) + sizeof(PixelFeatures)) <
           options_.compile.detail.memory_bytes / share;
}

void Drawing::note(const Sampling& sampling, std::size_t traced) {
    if (traced == pixels()) {
        report_.samples_a_pixel = sampling.samples_a_pixel();
        report_.fewer_where_calm = sampling.noise_255 > 0;
        return;
    }
    report_.finer_samples_a_pixel = sampling.samples_a_pixel();
    report_.finer_share = static_cast<double>(traced) / static_cast<double>(pixels());
}

std::size_t Drawing::trace(PictureTracer& tracer, const Sampling& sampling) {
    const Stopwatch watch;
    const double done = samples_ ? samples_done_ : 0;
    std::size_t traced = 0;
    const WorkerThreads workers(options_.threads);
    TraceControl control = control_by(workers);
    control.samples = samples_;
    control.on_tile = [&](const Tile& tile) {
        traced += tile.pixels();
        const double share = static_cast<double>(traced) / static_cast<double>(pixels());
        film_.tile(tile, picture_, pass_);
        tell((done_ + share * (sampling.samples_a_pixel() - done)) / work_);
    };
    tracer.trace(sampling, control, window_, picture_, options_.needs_aovs() ? &aovs_ : nullptr);
    done_ += sampling.samples_a_pixel() - done;
    if (samples_) samples_done_ = sampling.samples_a_pixel();
    report_.seconds += watch.seconds();
    return traced;
}

TraceControl Drawing::control_by(const Workers& workers) const {
    TraceControl control;
    control.workers = &workers;
    control.sequence = options_.sequence;
    control.cancelled = [this] { return cancel_.raised(); };
    return control;
}

void Drawing::tell(double fraction) const {
    if (options_.on_progress)
        options_.on_progress({report_.pictures ? "refining" : "tracing", fraction, report_.samples_a_pixel});
}

} // namespace graftal
