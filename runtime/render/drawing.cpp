#include "runtime/render/drawing.h"

#include <algorithm>
#include <cmath>

#include "runtime/fit/fit_picture.h"
#include "runtime/system/worker_threads.h"

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

Drawing::Drawing(const View& view, const RenderOptions& options, PictureFilm& film, const CancelFlag& cancel)
    : options_(options), film_(film), cancel_(cancel), window_(window_of(options, view.size)) {
    picture_.width = window_.width;
    picture_.height = window_.height;
    picture_.channels = 3;
    picture_.pixels.resize(3 * pixels());
    if (options.needs_aovs()) aovs_.resize(pixels());
    film.begin({window_, picture_.channels, view.film});
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
    if (options_.progressive && finest.most_samples > 0 && !options_.needs_aovs() && has_room_for_samples()) {
        meters.resize(pixels());
        samples_ = &meters;
        Sampling round = finest;
        const double soon = std::max(1.0, std::ceil(seconds_a_round / std::max(sample_seconds, 1e-9)));
        for (double count = soon; 2 * count < finest.most_samples; count *= growth_of_rounds) {
            round.most_samples = static_cast<int>(count);
            if (Status status = look(model, round); !status.ok()) return status;
        }
    }
    Status status = look(model, finest);
    report_.finished = status.ok();
    return status;
}

Status Drawing::look(const TraceModel& model, const Sampling& sampling) {
    PictureTracer tracer(model, limits_of(model.prepared, model.view, options_));
    const std::size_t traced = trace(tracer, sampling);
    // The noise is that of the last look alone.
    report_.rays.noisy_pixels = report_.rays.noise_1024 = report_.rays.measured_pixels = 0;
    report_.rays += tracer.statistics();
    report_.error_px = model.options.culls() ? model.projection.error_px() : 0;
    const bool complete = traced == pixels();
    if (!complete && !worth_leaving()) return interrupted();
    const Status status = film_.end(pass_++, picture_, aovs());
    if (!status.ok()) return status;
    if (report_.pictures++ == 0) report_.first_picture_seconds = watch_.seconds();
    note(sampling, traced);
    return complete ? status : interrupted();
}

bool Drawing::has_room_for_samples() const {
    constexpr std::uint64_t share = 4; // of the memory
    return pixels() * sizeof(NoiseMeter) < options_.compile.detail.memory_bytes / share;
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
    TraceControl control;
    const WorkerThreads workers(options_.threads);
    control.workers = &workers;
    control.sequence = options_.sequence;
    control.samples = samples_;
    control.cancelled = [this] { return cancel_.raised(); };
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

void Drawing::tell(double fraction) const {
    if (options_.on_progress)
        options_.on_progress({report_.pictures ? "refining" : "tracing", fraction, report_.samples_a_pixel});
}

} // namespace graftal
