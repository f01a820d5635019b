#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/light/film.h"
#include "runtime/image/image.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/render.h"
#include "runtime/render/stopwatch.h"
#include "runtime/trace/aovs.h"
#include "runtime/trace/noise_meter.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

/// The part of a picture of this size that is drawn.
Tile window_of(const RenderOptions& options, ImageSize size);

/// One picture of the native engine, from the first sample to the last file. All that it is made of must
/// outlive it.
class Drawing {
  public:
    Drawing(const View& view, const CutGraph& cut, const RenderOptions& options, const PictureSink& sink,
            const CancelFlag& cancel);

    /// Coarse looks, one after the other. `work`: samples a pixel of all looks, earlier and later ones too.
    Status look(const TraceModel& model, const std::vector<Sampling>& looks, double work);

    /// The finest look, after others or alone. `sample_seconds`: as FittedModel's.
    Status finish(const TraceModel& model, const Sampling& finest, double sample_seconds);

    double done() const { return done_; } ///< samples a pixel

    const NativeReport& report() const { return report_; }

  private:
    Status look(const TraceModel& model, const Sampling& sampling);
    bool has_room_for_samples() const;
    std::size_t pixels() const { return window_.pixels(); }
    /// A picture that is cut short is finer than the one that is there.
    bool worth_leaving() const { return options_.progressive && report_.pictures > 0; }
    void note(const Sampling& sampling, std::size_t traced);
    /// Returns the number of finished pixels: all, unless it was interrupted.
    std::size_t trace(PictureTracer& tracer, const Sampling& sampling);
    void tell(double fraction) const;
    Status write();
    Image encoded() const;

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
    std::vector<NoiseMeter>* samples_ = nullptr;    ///< TraceControl::samples, in finish()
    double work_ = 0, done_ = 0, samples_done_ = 0; ///< samples a pixel; the last: of samples_
};

} // namespace graftal
