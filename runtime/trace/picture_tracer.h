#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "compiler/support/workers.h"
#include "runtime/image/image.h"
#include "runtime/trace/aovs.h"
#include "runtime/trace/model/trace_model.h"
#include "runtime/trace/noise_meter.h"
#include "runtime/trace/pixel_features.h"
#include "runtime/trace/sampling.h"
#include "runtime/trace/shade/shade.h"
#include "runtime/trace/tile.h"

namespace graftal {

struct TraceControl {
    const Workers* workers = nullptr; ///< null: the thread that asks works alone
    /// Null, or the samples that each pixel of the window has so far, by light that is sampled: a trace goes
    /// on after them, and then the picture is the one that a single trace of as many samples makes.
    std::vector<NoiseMeter>* samples = nullptr;
    /// Number of the samples' random sequence: pictures of different sequences differ in their noise.
    std::uint64_t sequence = 0;
    /// Asked before every ray, by all threads at once: one tile may hold millions of rays. Once it says true,
    /// no further ray is traced.
    std::function<bool()> cancelled;
    /// Raised when nobody wants the picture any more, now or later: shells that are under way end too.
    CancelFlag for_good{};
    /// After each whole one, with what of it lies in the window; by one thread at a time.
    std::function<void(const Tile&)> on_tile;
};

/// Makes pictures of a model by the traversal. The samples are the same, to the last bit, whatever the number
/// of threads; memory beyond the picture is O(threads * depth).
class PictureTracer {
  public:
    /// Keeps a reference to the model.
    explicit PictureTracer(const TraceModel& model, const ShaderLimits& limits = {});

    /// Fills the picture: linear light, not clamped. Pixels that a cancelled trace did not come to stay as
    /// they were; then false. Requires three channels and the size of the view. `aovs`, if it is not null,
    /// has a pixel for each of the picture, and is filled likewise.
    bool trace(const Sampling& sampling, const TraceControl& control, Image& picture,
               AovPicture* aovs = nullptr);

    /// Traces a window of the picture, whose pixels have the very bits that they have in the whole:
    /// `picture` and `aovs` hold nothing else. Requires a window that lies in the view.
    bool trace(const Sampling& sampling, const TraceControl& control, const Tile& window, Image& picture,
               AovPicture* aovs = nullptr);

    /// The mean features of each pixel of a window, by so many rays from the camera through the square of
    /// each pixel. False if it was cancelled.
    bool trace_features(int rays, const TraceControl& control, const Tile& window,
                        std::vector<PixelFeatures>& features);

    /// Traces the camera rays number `begin` to `end` of a sequence that covers the picture evenly at any
    /// length, and each side of it: what is thin is met as often as its share of the picture says, too (the
    /// R2 sequence: a Kronecker sequence of the plastic number). Shows nothing; false if it was cancelled.
    bool probe(std::uint64_t begin, std::uint64_t end, const TraceControl& control);

    /// Counts of all traces so far.
    const TraceStatistics& statistics() const { return statistics_; }

  private:
    template<class Task> bool run(std::uint64_t tasks, const TraceControl& control, const Task& task);

    const TraceModel& model_;
    ShaderLimits limits_;
    TraceStatistics statistics_;
};

} // namespace graftal
