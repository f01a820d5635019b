#include "runtime/render/fit_work.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
/// Of the work, what a first look may take: its rays are given up in time, and those count as if they went on
/// to the end.
constexpr double most_for_first_look = 0.1;
constexpr double rays_a_block = 3, steps_a_visit = 4;
constexpr double coarser = 1.5;
constexpr int most_coarser_steps = 9;
/// All is made anew after the memory did not suffice: few tries must do.
constexpr int steps_after_memory = 3;
constexpr std::uint64_t fewest_visits = 16;
/// By how much a coarser picture may take less: more where crowds are seen, hardly any where surfaces
/// overlap.
constexpr double most_gain = coarser * coarser * coarser;
/// Of what is allowed: a look that takes more for shells is broken off, since the picture takes more, too. It
/// is taken for one that takes so many times what is allowed.
constexpr double most_for_shells = 0.5, broken_off = 4;

class Fitting {
  public:
    Fitting(const View& view, const CutOptions& options, double samples_a_pixel,
            const std::function<ShaderLimits(const TraceModel&)>& limits_of, int threads,
            const std::function<bool()>& cancelled)
        : view_(view), options_(options), samples_(samples_a_pixel * view.size.width * view.size.height),
          limits_of_(limits_of), threads_(threads), cancelled_(cancelled) {}

    FittedModel run(const std::function<PreparedCut()>& prepare) {
        FittedModel fitted = fit(prepare);
        fitted.tried_seconds = tried_seconds_;
        return fitted;
    }

  private:
    FittedModel fit(const std::function<PreparedCut()>& prepare) {
        FittedModel fitted;
        CutOptions options = options_;
        int steps_left = options.culls() ? most_coarser_steps : 0;
        make_anew(prepare, options, steps_left, fitted);
        fitted.whole_seconds = fitted.seconds;
        fitted.allowed_seconds = std::numeric_limits<double>::infinity();
        if (!options.culls()) return fitted;
        fitted.work_cut = too_much(fitted.seconds);
        while (steps_left > 0 && too_much(fitted.seconds)) {
            const double steps = std::log(excess(fitted.seconds)) / std::log(most_gain);
            // Each look that is broken off takes much of the time there is: there are to be few.
            const int least = 1 << broken_looks_;
            for (int i = 0; (i < least || i < steps) && (i == 0 || steps_left > 0); ++i)
                make_coarser(options, steps_left);
            PreparedCut prepared = std::move(fitted.model->prepared);
            fitted.model.reset();
            if (!make(std::move(prepared), options, fitted)) {
                note_memory(options, steps_left, fitted);
                make_anew(prepare, options, steps_left, fitted);
            }
        }
        while (too_much(fitted.seconds) && fitted.model->most_visits > fewest_visits) {
            const std::uint64_t fewer = excess(fitted.seconds) > 4 ? 4 : 2;
            fitted.model->most_visits = std::max(fitted.model->most_visits / fewer, fewest_visits);
            fitted.rays_cut = true;
            fitted.seconds = seconds_for(*fitted.model);
        }
        fitted.allowed_seconds = allowed();
        return fitted;
    }

    static void make_coarser(CutOptions& options, int& steps_left) {
        --steps_left;
        options.error_px *= coarser;
        if (options.error_world) *options.error_world *= coarser;
    }

    void note_memory(CutOptions& options, int& steps_left, FittedModel& fitted) {
        fitted.out_of_memory = true;
        if (steps_left == 0 || failed_seconds_ > work_seconds_) throw std::bad_alloc();
        for (int i = 0; i < steps_after_memory && steps_left > 0; ++i)
            make_coarser(options, steps_left);
    }

    /// As coarse as the memory asks for.
    void make_anew(const std::function<PreparedCut()>& prepare, CutOptions& options, int& steps_left,
                   FittedModel& fitted) {
        while (!make(prepare(), options, fitted))
            note_memory(options, steps_left, fitted);
    }

    /// False where it takes more memory than there is.
    bool make(PreparedCut prepared, const CutOptions& options, FittedModel& fitted) {
        const std::uint64_t instances = prepared.instances;
        work_seconds_ = work_beside_graph(options_.work_seconds, instances);
        slowness_ = slowness_of_graph(instances);
        try {
            fitted.model = std::make_unique<TraceModel>(std::move(prepared), view_, options);
            tried_seconds_ += slowness_ * static_cast<double>(fitted.model->weighed) / WorkRates::kinds;
            fitted.error_px = options.error_px;
            fitted.seconds = seconds_for(*fitted.model);
            return true;
        } catch (const std::bad_alloc&) {
            fitted.model.reset();
            failed_seconds_ += static_cast<double>(instances) / WorkRates::instances;
            return false;
        }
    }

    /// Trying takes its share, too; the picture keeps half in any case.
    double allowed() const { return std::max(work_seconds_ - tried_seconds_, 0.5 * work_seconds_); }

    double excess(double seconds) const { return seconds / allowed(); }

    bool too_much(double seconds) const { return excess(seconds) > 1 && !cancelled_(); }

    static double shell_seconds(const TraceModel& model) {
        return static_cast<double>(model.meshes.shell_work()) / WorkRates::shell_points;
    }

    double seconds_for(TraceModel& model) {
        const int broken_before = broken_looks_;
        const double first = seconds_by(model, first_block);
        if (broken_looks_ > broken_before || excess(first) > clear_factor || clear_factor * excess(first) < 1)
            return first;
        return seconds_by(model, second_block);
    }

    /// Parts that each ray of a first look may go into.
    std::uint64_t visits_of_first_look() const {
        const double blocks = std::ceil(view_.size.width / static_cast<double>(first_block)) *
                              std::ceil(view_.size.height / static_cast<double>(first_block));
        const double steps = most_for_first_look * work_seconds_ * WorkRates::ray_steps / slowness_;
        const double visits = steps / (rays_a_block * steps_a_visit * blocks);
        return static_cast<std::uint64_t>(std::clamp<double>(visits, fewest_visits, 1e9));
    }

    double seconds_by(TraceModel& model, int block) {
        const std::uint64_t whole_visits = model.most_visits;
        if (block == first_block && options_.culls())
            model.most_visits = std::min(whole_visits, visits_of_first_look());
        const double visits_left = static_cast<double>(whole_visits - model.most_visits);
        const double shells_before = shell_seconds(model);
        PictureTracer tracer(model, limits_of_(model));
        Image picture;
        picture.width = view_.size.width;
        picture.height = view_.size.height;
        picture.channels = 3;
        picture.pixels.resize(3 * static_cast<std::size_t>(picture.width) *
                              static_cast<std::size_t>(picture.height));
        TraceControl control;
        control.threads = threads_;
        const double most_shells = most_for_shells * allowed();
        const auto too_many_shells = [&] { return options_.culls() && shell_seconds(model) > most_shells; };
        control.cancelled = [&] { return cancelled_() || too_many_shells(); };
        if (options_.culls())
            model.meshes.make_until(static_cast<std::uint64_t>(most_shells * WorkRates::shell_points));
        tracer.trace({block, {}}, control, picture);
        model.meshes.make_until(UINT64_MAX);
        model.most_visits = whole_visits;
        if (too_many_shells()) { // how many there are by now depends on the threads
            tried_seconds_ += most_shells;
            ++broken_looks_;
            return broken_off * allowed();
        }
        const TraceStatistics& tried = tracer.statistics();
        const double shells = shell_seconds(model);
        const double steps_left = static_cast<double>(tried.given_up) * steps_a_visit * visits_left;
        const double second_of_steps = slowness_ / WorkRates::ray_steps;
        const double rays = second_of_steps * (static_cast<double>(tried.work) + steps_left);
        tried_seconds_ += second_of_steps * static_cast<double>(tried.work) + shells - shells_before;
        return rays * samples_ / std::max<double>(1, static_cast<double>(tried.camera_rays)) + shells;
    }

    const View& view_;
    const CutOptions& options_;
    const double samples_;
    const std::function<ShaderLimits(const TraceModel&)>& limits_of_;
    const int threads_;
    const std::function<bool()>& cancelled_;
    double work_seconds_ = 0;   ///< for the rays, and for what is tried
    double slowness_ = 1;       ///< of their steps
    double failed_seconds_ = 0; ///< that models took for which the memory did not suffice
    double tried_seconds_ = 0;  ///< that rays, shells and weights took
    int broken_looks_ = 0;
};

} // namespace

FittedModel fit_work(const std::function<PreparedCut()>& prepare, const View& view, const CutOptions& options,
                     double samples_a_pixel, const std::function<ShaderLimits(const TraceModel&)>& limits_of,
                     int threads, const std::function<bool()>& cancelled) {
    return Fitting(view, options, samples_a_pixel, limits_of, threads, cancelled).run(prepare);
}

} // namespace graftal
