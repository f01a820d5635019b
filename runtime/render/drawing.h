#pragma once

#include <cstddef>
#include <vector>

#include "runtime/image/image.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/render.h"
#include "runtime/render/stopwatch.h"
#include "runtime/trace/aovs.h"
#include "runtime/trace/noise_meter.h"
#include "runtime/trace/picture_film.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

/// The part of a picture of this size that is drawn.
Tile window_of(const RenderOptions& options, ImageSize size);

/// One picture of the native engine, from the first sample to the last pass, onto a film. All that it is made
/// of must outlive it.
class Drawing {
  public:
    Drawing(const PreparedView& prepared, const RenderOptions& options, PictureFilm& film,
            const CancelFlag& cancel);

    /// Coarse looks, one after the other. `work`: samples a pixel of all looks, earlier and later ones too.
    Status look(const TraceModel& model, const std::vector<Sampling>& looks, double work);

    /// The finest look, after others or alone. `sample_seconds`: as FittedModel's.
    Status finish(const TraceModel& model, const Sampling& finest, double sample_seconds);

    double done() const { return done_; } ///< samples a pixel

    const NativeReport& report() const { return report_; }

  private:
    Status look(const TraceModel& model, const Sampling& sampling, bool last = false);
    bool denoise(PictureTracer& tracer, const Sampling& sampling, const Film& film);
    TraceControl control_by(const Workers& workers) const;
    bool has_room_for_samples() const;
    std::size_t pixels() const { return window_.pixels(); }
    /// A picture that is cut short is finer than the one that is there.
    bool worth_leaving() const { return options_.progressive && report_.pictures > 0; }
    void note(const Sampling& sampling, std::size_t traced);
    /// Returns the number of finished pixels: all, unless it was interrupted.
    std::size_t trace(PictureTracer& tracer, const Sampling& sampling);
    void tell(double fraction) const;
    const AovPicture* aovs() const { return options_.needs_aovs() ? &aovs_ : nullptr; }

    const RenderOptions& options_;
    PictureFilm& film_;
    const CancelFlag& cancel_;
    Tile window_; ///< of the picture
    Image picture_;
    AovPicture aovs_; ///< empty where none are asked for
    NativeReport report_;
    int pass_ = 0;
    Stopwatch watch_;
    std::vector<NoiseMeter>* samples_ = nullptr;    ///< TraceControl::samples, in finish()
    double work_ = 0, done_ = 0, samples_done_ = 0; ///< samples a pixel; the last: of samples_
};

} // namespace graftal
