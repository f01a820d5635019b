#include "runtime/studio/picture/progressive_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/image/develop.h"
#include "runtime/studio/picture/clock.h"
#include "runtime/trace/denoise.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

namespace {

/// Blocks of rough passes, in pixels along a side.
constexpr int finest_rough = 4, usual_rough = 16, coarsest_rough = 64;
/// Seconds that the first rough pass, and a later one, may take by what is known so far.
constexpr double soon_seconds = 0.04, later_seconds = 0.5;
/// Rays that are traced before the first pass, and the seconds after which they have said enough.
constexpr std::uint64_t probe_rays = 64;
constexpr double probe_seconds = 0.04;
/// The rough model, against the one that is asked for: coarser errors, and fewest parts a ray.
constexpr double rough_error = 8;
constexpr std::uint64_t rough_visits = 1024;
constexpr double rough_work_seconds = 0.5;
/// Blocks from which on a pass is one piece of work.
constexpr int whole_block = 8;
/// Pixels along a side of a window: for one worker, which hears nothing while it draws one, for few, and for
/// many.
constexpr int lone_window_px = 64, window_px = 128, wide_window_px = 256, few_workers = 4;

int window_side(int workers) {
    if (workers == 1) return lone_window_px;
    return workers > few_workers ? wide_window_px : window_px;
}

/// Samples of a pass for each of the pass before.
constexpr int growth_of_samples = 4;

double samples_in(ImageSize size, const Sampling& sampling) {
    return sampling.samples_a_pixel() * size.width * size.height;
}

/// The windows of a picture, from its middle outwards.
std::vector<Tile> windows_of(ImageSize size, int side) {
    std::vector<Tile> tiles;
    for (int y = 0; y < size.height; y += side)
        for (int x = 0; x < size.width; x += side)
            tiles.push_back({x, y, std::min(side, size.width - x), std::min(side, size.height - y)});
    const auto off_middle = [&](const Tile& tile) {
        return std::hypot(tile.x + 0.5 * tile.width - 0.5 * size.width,
                          tile.y + 0.5 * tile.height - 0.5 * size.height);
    };
    std::ranges::stable_sort(tiles, {}, off_middle);
    return tiles;
}

Image image_of(int width, int height) {
    Image image{width, height, 3, {}};
    image.pixels.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return image;
}

/// One sample of each block.
Image thinned(const Image& picture, int block) {
    Image image = image_of((picture.width + block - 1) / block, (picture.height + block - 1) / block);
    auto out = image.pixels.begin();
    for (int y = 0; y < picture.height; y += block)
        for (int x = 0; x < picture.width; x += block)
            out = std::copy_n(picture.pixels.begin() + 3 * (std::ptrdiff_t{y} * picture.width + x), 3, out);
    return image;
}

} // namespace

std::vector<ShownTile> tiles_of_picture(const Image& developed, int pass) {
    std::vector<ShownTile> tiles;
    for (const Tile& window : windows_of({developed.width, developed.height}, wide_window_px)) {
        ShownTile tile{window, 1, pass, {}};
        for (int y = window.y; y < window.y + window.height; ++y)
            for (int x = window.x; x < window.x + window.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto pixel =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(developed.width) +
                        static_cast<std::size_t>(x);
                    // A grey picture has one channel for all.
                    const int channel = developed.channels < 3 ? 0 : c;
                    const std::size_t sample = static_cast<std::size_t>(developed.channels) * pixel +
                                               static_cast<std::size_t>(channel);
                    tile.rgb8 += static_cast<char>(level8_of(developed.pixels[sample]));
                }
        tiles.push_back(std::move(tile));
    }
    return tiles;
}

ProgressivePicture::ProgressivePicture(PreparedView prepared, const PictureWishes& wishes,
                                       std::function<const Workers&()> workers,
                                       std::shared_ptr<TraceBasis> basis, double seconds_a_sample,
                                       PicturePasses passes)
    : prepared_(std::move(prepared)), wishes_(wishes), workers_(std::move(workers)), passes_(passes),
      plan_(plan_picture(prepared_, wishes)), basis_(std::move(basis)),
      phase_(passes == PicturePasses::all ? Phase::begin : Phase::fit), seconds_a_sample_(seconds_a_sample) {}

bool ProgressivePicture::step(const std::function<bool()>& cancelled, const std::function<bool()>& for_good,
                              const PictureListener& listener) try {
    switch (phase_) {
    case Phase::begin:
        begin(cancelled, for_good);
        return true;
    case Phase::fit:
        fit(for_good);
        return true;
    case Phase::rough:
    case Phase::fine:
        if (trace(cancelled, for_good, listener) &&
            next_window_ == (whole_.empty() ? windows_ : whole_).size())
            end_pass(listener);
        return true;
    case Phase::denoise:
        denoise_next(cancelled, for_good, listener);
        return true;
    case Phase::done:
        break;
    }
    return false;
} catch (const Cancelled&) {
    return true;
}

/// Makes the rough model, and learns what its rays take.
void ProgressivePicture::begin(const std::function<bool()>& cancelled,
                               const std::function<bool()>& for_good) {
    if (!rough_) {
        const CancelFlag cancel(for_good);
        DetailOptions options = plan_.detail;
        if (options.culls()) {
            options.error_px *= rough_error;
            if (options.error_world) *options.error_world *= rough_error;
        }
        // Bounds and shadows take shares of the work, and nothing ends them early.
        options.work_seconds = std::min(options.work_seconds, rough_work_seconds);
        if (!basis_) basis_ = std::make_shared<TraceBasis>(*prepared_.prepared, options.work_seconds, cancel);
        rough_ = std::make_unique<TraceModel>(prepared_.prepared, view(), options, prepared_.textures, basis_,
                                              cancel);
        rough_->most_visits = std::min(rough_->most_visits, rough_visits);
    }
    if (!(seconds_a_sample_ > 0)) probe(cancelled, for_good);
    phase_ = Phase::rough;
    int block = usual_rough / 2;
    while (block < coarsest_rough && seconds_of({.block = block}) > soon_seconds)
        block *= 2;
    start_pass({.block = block});
}

void ProgressivePicture::probe(const std::function<bool()>& cancelled,
                               const std::function<bool()>& for_good) {
    PictureTracer tracer(*rough_, limits_of(*prepared_.prepared, view(), wishes_));
    TraceControl control;
    control.workers = &workers_();
    const double start = clock_seconds();
    control.cancelled = [&] { return cancelled() || clock_seconds() - start > probe_seconds; };
    control.for_good = CancelFlag(for_good);
    tracer.probe(0, probe_rays, control);
    const auto rays = static_cast<double>(std::max<std::uint64_t>(tracer.statistics().camera_rays, 1));
    seconds_a_sample_ = (clock_seconds() - start) / rays;
}

double ProgressivePicture::seconds_of(const Sampling& sampling) const {
    return seconds_a_sample_ * samples_in(view().size, sampling);
}

void ProgressivePicture::start_pass(const Sampling& sampling) {
    sampling_ = sampling;
    next_window_ = 0;
    statistics_ = {};
    pass_seconds_ = pass_samples_ = 0;
    whole_.clear();
    if (sampling.block >= whole_block) {
        whole_.push_back({whole_of(view().size), {}});
    } else if (windows_.empty()) {
        for (const Tile& tile : windows_of(view().size, window_side(workers_().count())))
            windows_.push_back({tile, {}});
    }
}

/// Traces the next window. False if it was cancelled.
bool ProgressivePicture::trace(const std::function<bool()>& cancelled, const std::function<bool()>& for_good,
                               const PictureListener& listener) {
    Window& window = (whole_.empty() ? windows_ : whole_)[next_window_];
    const TraceModel& model = phase_ == Phase::rough ? *rough_ : *fitted_.model;
    TraceControl control;
    control.workers = &workers_();
    control.cancelled = cancelled;
    control.for_good = CancelFlag(for_good);
    if (sampling_->most_samples > 0) {
        window.meters.resize(window.tile.pixels());
        control.samples = &window.meters;
    }
    Image picture = image_of(window.tile.width, window.tile.height);
    PictureTracer tracer(model, limits_of(*prepared_.prepared, view(), wishes_));
    const double start = clock_seconds();
    const bool whole = tracer.trace(*sampling_, control, window.tile, picture);
    pass_seconds_ += clock_seconds() - start;
    pass_samples_ += static_cast<double>(tracer.statistics().camera_rays);
    if (!whole) return false;
    statistics_ += tracer.statistics();
    show(window, picture, listener);
    ++next_window_;
    return true;
}

void ProgressivePicture::show(const Window& window, const Image& picture,
                              const PictureListener& listener) const {
    const int block = sampling_->block;
    Image shown = block > 1 ? thinned(picture, block) : picture;
    const Developer developer(view().film, SampleFormat::srgb8, window.tile.x / block, window.tile.y / block);
    developer.develop(shown, 0, shown.height);
    ShownTile tile{window.tile, block, pass_, {}};
    tile.rgb8.reserve(shown.pixels.size());
    for (const float sample : shown.pixels)
        tile.rgb8 += static_cast<char>(level8_of(sample));
    listener.on_tile(std::move(tile));
}

void ProgressivePicture::end_pass(const PictureListener& listener) {
    if (pass_samples_ > 0) seconds_a_sample_ = pass_seconds_ / pass_samples_;
    ShownPass shown;
    shown.pass = pass_++;
    shown.samples = sampling_->samples_a_pixel();
    shown.noise_255 = statistics_.noise_255();
    const TraceModel& model = phase_ == Phase::rough ? *rough_ : *fitted_.model;
    if (model.options.culls()) shown.error_px = model.projection.error_px();
    if (phase_ == Phase::rough) {
        rough_seconds_a_sample_ = seconds_a_sample_;
        plan_rough();
    } else if (queue_.empty()) {
        finish();
    } else {
        const double before = sampling_->most_samples > 0 ? sampling_->samples_a_pixel() : 0;
        const Sampling& last = queue_.front();
        const double left = last.samples_a_pixel() - (last.most_samples > 0 ? before : 0);
        shown.seconds_left = seconds_a_sample_ * std::max(left, 0.0) * view().size.width * view().size.height;
        start_pass(queue_.back());
        queue_.pop_back();
    }
    shown.done = phase_ == Phase::done;
    if (shown.done) shown.whole_seconds = seconds_of_whole();
    listener.on_pass(shown);
}

/// Nothing where the picture is as fine as it was asked for.
std::optional<double> ProgressivePicture::seconds_of_whole() const {
    const bool is_coarser =
        fitted_.sampling != plan_.wanted || fitted_.rays_cut || fitted_.error_px > plan_.detail.error_px;
    if (!is_coarser) return std::nullopt;
    return fitted_.whole_seconds / workers_().count();
}

/// The last pass is there, noise and all.
void ProgressivePicture::finish() {
    if (phase_ == Phase::fine && sampling_->feature_rays() > 0) {
        phase_ = Phase::denoise;
        next_window_ = 0;
        return;
    }
    phase_ = Phase::done;
    for (Window& window : windows_) {
        window.meters = {};
        window.features = {};
    }
}

/// Traces the features of the next window, or denoises the picture after the last.
void ProgressivePicture::denoise_next(const std::function<bool()>& cancelled,
                                      const std::function<bool()>& for_good,
                                      const PictureListener& listener) {
    if (next_window_ == windows_.size()) {
        denoise_all(cancelled, listener);
        return;
    }
    Window& window = windows_[next_window_];
    window.features.resize(window.tile.pixels());
    TraceControl control;
    control.workers = &workers_();
    control.cancelled = cancelled;
    control.for_good = CancelFlag(for_good);
    PictureTracer tracer(*fitted_.model, limits_of(*prepared_.prepared, view(), wishes_));
    if (tracer.trace_features(sampling_->feature_rays(), control, window.tile, window.features))
        ++next_window_;
}

void ProgressivePicture::denoise_all(const std::function<bool()>& cancelled,
                                     const PictureListener& listener) {
    const ImageSize size = view().size;
    const auto width = static_cast<std::size_t>(size.width);
    std::vector<NoiseMeter> meters(width * static_cast<std::size_t>(size.height));
    std::vector<PixelFeatures> features(meters.size());
    const auto for_rows = [&](const Window& window, const auto& copy) {
        for (int y = 0; y < window.tile.height; ++y)
            copy(std::ptrdiff_t{y} * window.tile.width,
                 std::ptrdiff_t{window.tile.y + y} * size.width + window.tile.x);
    };
    for (const Window& window : windows_)
        for_rows(window, [&](std::ptrdiff_t from, std::ptrdiff_t to) {
            std::copy_n(window.meters.begin() + from, window.tile.width, meters.begin() + to);
            std::copy_n(window.features.begin() + from, window.tile.width, features.begin() + to);
        });
    const CancelFlag cancel(cancelled);
    const Denoised denoised =
        denoise(meters, features, size.width, size.height, view().film, workers_(), cancel);
    if (cancel.raised()) return;
    for (const Window& window : windows_) {
        Image picture = image_of(window.tile.width, window.tile.height);
        for_rows(window, [&](std::ptrdiff_t from, std::ptrdiff_t to) {
            std::copy_n(denoised.picture.pixels.begin() + 3 * to, 3 * window.tile.width,
                        picture.pixels.begin() + 3 * from);
        });
        show(window, picture, listener);
    }
    finish();
    ShownPass shown;
    shown.pass = pass_++;
    shown.samples = sampling_->samples_a_pixel();
    shown.noise_255 = denoised.mean_error_255();
    if (fitted_.model->options.culls()) shown.error_px = fitted_.model->projection.error_px();
    shown.done = true;
    shown.whole_seconds = seconds_of_whole();
    listener.on_pass(shown);
}

/// Finer passes of the rough model as long as they are soon there.
void ProgressivePicture::plan_rough() {
    for (const int step : {4, 2}) {
        const Sampling finer{.block = sampling_->block / step};
        if (finer.block < finest_rough || seconds_of(finer) > later_seconds) continue;
        start_pass(finer);
        return;
    }
    phase_ = Phase::fit;
}

void ProgressivePicture::fit(const std::function<bool()>& for_good) {
    std::optional<FittedModel> fitted = fit_picture(prepared_, wishes_, plan_, workers_(), for_good);
    if (!fitted) return;
    fitted_ = *std::move(fitted);
    rough_.reset();
    plan_fine();
}

void ProgressivePicture::plan_fine() {
    phase_ = Phase::fine;
    queue_ = {fitted_.sampling};
    if (passes_ == PicturePasses::all) queue_passes_before(fitted_.sampling);
    start_pass(queue_.back());
    queue_.pop_back();
}

void ProgressivePicture::queue_passes_before(const Sampling& finest) {
    if (finest.most_samples > 0) {
        Sampling fewer = finest;
        for (int count = finest.most_samples / growth_of_samples; count > 0; count /= growth_of_samples) {
            fewer.most_samples = count;
            queue_.push_back(fewer);
        }
    } else if (finest.block == 1 && finest.antialias) {
        queue_.push_back({});
    }
    if (finest.block == 1) queue_.push_back({.block = 2});
}

} // namespace graftal
