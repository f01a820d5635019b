#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/support/workers.h"
#include "runtime/fit/fit_picture.h"
#include "runtime/trace/noise_meter.h"
#include "runtime/trace/pixel_features.h"
#include "runtime/trace/tile.h"

namespace graftal {

/// A part of a picture as people see it.
struct ShownTile {
    Tile tile;
    int block = 1;    ///< pixels that a sample stands for, along each side
    int pass = 0;     ///< from 0
    std::string rgb8; ///< rows of ceil(width / block) samples
};

/// A pass that has covered the whole picture.
struct ShownPass {
    int pass = 0;
    double samples = 0;                 ///< a pixel
    std::optional<double> seconds_left; ///< nothing: nobody knows yet
    std::optional<double> noise_255;    ///< mean of the pixels that have two samples or more
    double error_px = 0;                ///< of parts that are left out
    bool done = false;
    /// About the seconds, with all workers, of the picture as it was asked for, at a last pass that is
    /// coarser since the work allowed does not suffice.
    std::optional<double> whole_seconds;
};

/// The passes that somebody wants to see.
enum class PicturePasses { all, last };

/// The tiles of a whole picture that is developed already.
std::vector<ShownTile> tiles_of_picture(const Image& developed, int pass);

struct PictureListener {
    std::function<void(ShownTile)> on_tile;
    std::function<void(const ShownPass&)> on_pass;
};

/// A picture that is there soon, coarse, and then finer from pass to pass, until it is the one of the command
/// line. It is made piece by piece, so that one thread can do other things in between. Until the model is
/// fitted to the work allowed, a rougher one stands in for it, and the clock decides how coarse its
/// passes are. The last passes depend on no clock.
class ProgressivePicture {
  public:
    /// `workers` is asked for at each piece. `basis`: of the rough model of the same prepared graph, or null.
    /// `seconds_a_sample`: of the rough passes of a picture like this one; 0: nobody knows.
    ProgressivePicture(PreparedView prepared, const PictureWishes& wishes,
                       std::function<const Workers&()> workers, std::shared_ptr<TraceBasis> basis = nullptr,
                       double seconds_a_sample = 0, PicturePasses passes = PicturePasses::all);

    /// Does the next piece. `cancelled` is asked before each ray, by all workers; a piece that it ends is
    /// done again, apart from samples that are there. False: the picture was finished already. `for_good`
    /// says that the whole picture is not wanted any more: models are made, and fitted, until it says so.
    bool step(const std::function<bool()>& cancelled, const std::function<bool()>& for_good,
              const PictureListener& listener);

    /// Seconds of the clock for a sample of the rough passes; 0 before them.
    double rough_seconds_a_sample() const { return rough_seconds_a_sample_; }
    bool done() const { return phase_ == Phase::done; }
    /// Only the passes are left that no clock decides on.
    bool is_rough() const { return phase_ == Phase::begin || phase_ == Phase::rough; }
    /// Passes that are complete.
    int passes() const { return pass_; }
    const std::shared_ptr<TraceBasis>& basis() const { return basis_; }
    const PreparedView& prepared() const { return prepared_; }
    /// The model that rays go through now; null before the first step.
    const TraceModel* model() const { return fitted_.model ? fitted_.model.get() : rough_.get(); }

  private:
    enum class Phase { begin, rough, fit, fine, denoise, done };

    struct Window {
        Tile tile;
        std::vector<NoiseMeter> meters;      ///< where light is sampled; empty before
        std::vector<PixelFeatures> features; ///< where it is denoised
    };

    void begin(const std::function<bool()>& cancelled, const std::function<bool()>& for_good);
    void probe(const std::function<bool()>& cancelled, const std::function<bool()>& for_good);
    void fit(const std::function<bool()>& for_good);
    bool trace(const std::function<bool()>& cancelled, const std::function<bool()>& for_good,
               const PictureListener& listener);
    void end_pass(const PictureListener& listener);
    void denoise_next(const std::function<bool()>& cancelled, const std::function<bool()>& for_good,
                      const PictureListener& listener);
    void denoise_all(const std::function<bool()>& cancelled, const PictureListener& listener);
    void finish();
    std::optional<double> seconds_of_whole() const;
    void plan_rough();
    void plan_fine();
    void queue_passes_before(const Sampling& finest);
    void start_pass(const Sampling& sampling);
    void show(const Window& window, const Image& picture, const PictureListener& listener) const;
    double seconds_of(const Sampling& sampling) const;
    const View& view() const { return prepared_.viewed->view; }

    PreparedView prepared_;
    PictureWishes wishes_;
    std::function<const Workers&()> workers_;
    PicturePasses passes_;
    PicturePlan plan_;
    std::shared_ptr<TraceBasis> basis_;
    std::unique_ptr<TraceModel> rough_;
    FittedModel fitted_;
    Phase phase_;
    std::vector<Sampling> queue_; ///< passes of this phase, the next one last
    std::optional<Sampling> sampling_;
    std::vector<Window> windows_; ///< of fine passes, from the middle outwards
    std::vector<Window> whole_;   ///< one window, of coarse passes
    std::size_t next_window_ = 0;
    TraceStatistics statistics_; ///< of the pass
    int pass_ = 0;
    double rough_seconds_a_sample_ = 0;
    double seconds_a_sample_ = 0; ///< of the clock, with all workers
    double pass_seconds_ = 0;     ///< so far
    double pass_samples_ = 0;     ///< rays of windows that are done
};

} // namespace graftal
