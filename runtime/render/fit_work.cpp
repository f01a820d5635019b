#include "runtime/render/fit_work.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "compiler/cut/work.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

namespace {

/// Sides of the blocks of pixels that one ray is tried for: the first look is short whatever comes.
constexpr int first_block = 64, second_block = 16;
/// A first look this far from what is allowed needs no second.
constexpr double clear_factor = 8;
constexpr double coarser = 1.5;
constexpr int most_coarser_steps = 9;
/// All is made anew after the memory did not suffice: few tries must do.
constexpr int steps_after_memory = 3;
constexpr std::uint64_t fewest_visits = 64;

class Fitting {
  public:
    Fitting(const View& view, const CutOptions& options, double samples_a_pixel,
            const std::function<ShaderLimits(const TraceModel&)>& limits_of, int threads,
            const std::function<bool()>& cancelled)
        : view_(view), options_(options), samples_(samples_a_pixel * view.size.width * view.size.height),
          limits_of_(limits_of), threads_(threads), cancelled_(cancelled) {}

    FittedModel run(const std::function<PreparedCut()>& prepare) {
        FittedModel fitted;
        CutOptions options = options_;
        int steps_left = options.culls() ? most_coarser_steps : 0;
        while (!make(prepare(), options, fitted)) {
            fitted.out_of_memory = true;
            if (steps_left == 0) throw std::bad_alloc();
            for (int i = 0; i < steps_after_memory && steps_left > 0; ++i)
                make_coarser(options, steps_left);
        }
        fitted.whole_seconds = fitted.seconds;
        if (!options.culls()) return fitted;
        while (steps_left > 0 && too_much(fitted.seconds)) {
            make_coarser(options, steps_left);
            PreparedCut prepared = std::move(fitted.model->prepared);
            fitted.model.reset();
            if (!make(std::move(prepared), options, fitted)) throw std::bad_alloc();
        }
        while (too_much(fitted.seconds) && fitted.model->most_visits > fewest_visits) {
            fitted.model->most_visits /= 2;
            fitted.rays_cut = true;
            fitted.seconds = seconds_for(*fitted.model);
        }
        return fitted;
    }

  private:
    static void make_coarser(CutOptions& options, int& steps_left) {
        --steps_left;
        options.error_px *= coarser;
        if (options.error_world) *options.error_world *= coarser;
    }

    /// False where it takes more memory than there is.
    bool make(PreparedCut prepared, const CutOptions& options, FittedModel& fitted) const {
        try {
            fitted.model = std::make_unique<TraceModel>(std::move(prepared), view_, options);
            fitted.error_px = options.error_px;
            fitted.seconds = seconds_for(*fitted.model);
            return true;
        } catch (const std::bad_alloc&) {
            fitted.model.reset();
            return false;
        }
    }

    bool too_much(double seconds) const { return seconds > options_.work_seconds && !cancelled_(); }

    double seconds_for(const TraceModel& model) const {
        const double first = seconds_by(model, first_block);
        if (first > clear_factor * options_.work_seconds || clear_factor * first < options_.work_seconds)
            return first;
        return seconds_by(model, second_block);
    }

    double seconds_by(const TraceModel& model, int block) const {
        PictureTracer tracer(model, limits_of_(model));
        Image picture;
        picture.width = view_.size.width;
        picture.height = view_.size.height;
        picture.channels = 3;
        picture.pixels.resize(3 * static_cast<std::size_t>(picture.width) *
                              static_cast<std::size_t>(picture.height));
        TraceControl control;
        control.threads = threads_;
        control.cancelled = cancelled_;
        tracer.trace({block, {}}, control, picture);
        const TraceStatistics& tried = tracer.statistics();
        const double visits =
            static_cast<double>(tried.visits) / std::max<double>(1, static_cast<double>(tried.camera_rays));
        return visits * samples_ / WorkRates::ray_parts +
               static_cast<double>(model.meshes.shell_work()) / WorkRates::shell_points;
    }

    const View& view_;
    const CutOptions& options_;
    const double samples_;
    const std::function<ShaderLimits(const TraceModel&)>& limits_of_;
    const int threads_;
    const std::function<bool()>& cancelled_;
};

} // namespace

FittedModel fit_work(const std::function<PreparedCut()>& prepare, const View& view, const CutOptions& options,
                     double samples_a_pixel, const std::function<ShaderLimits(const TraceModel&)>& limits_of,
                     int threads, const std::function<bool()>& cancelled) {
    return Fitting(view, options, samples_a_pixel, limits_of, threads, cancelled).run(prepare);
}

} // namespace graftal
