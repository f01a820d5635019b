#include "runtime/render/fit_work.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "compiler/detail/work.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

namespace {

/// Pixels that one ray is tried for, and the fewest rays: the first look is short whatever comes. The last is
/// close, since a hundredth of a picture may take all of the work, and still a small share of it.
constexpr std::uint64_t pixels_of_first_look = 4096, pixels_of_second_look = 256, pixels_of_last_look = 16;
constexpr std::uint64_t least_first_look = 16, least_second_look = 256;
/// A first look that finds this much more than what is allowed needs no second.
constexpr double clear_factor = 8;
/// Of the work, what a first look may take: its rays are given up in time, and those count as if they went on
/// to the end.
constexpr double most_for_first_look = 0.1;
constexpr double rays_a_look = 3, steps_a_visit = 4;
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
/// After so many the picture is made as coarse as may be.
constexpr int most_broken_looks = 2;

class Fitting {
  public:
    Fitting(std::shared_ptr<const PreparedCut> prepared, const View& view, const DetailOptions& options,
            const ModelTextures& textures, double samples_a_pixel, double fewest_a_pixel,
            const std::function<ShaderLimits(const TraceModel&)>& limits_of, int threads,
            const std::function<bool()>& cancelled,
            const std::function<void(const TraceModel&, double)>& on_first_look)
        : prepared_(std::move(prepared)), view_(view), options_(options), textures_(textures),
          samples_(samples_a_pixel * view.size.width * view.size.height),
          least_share_(fewest_a_pixel / samples_a_pixel), limits_of_(limits_of), threads_(threads),
          cancelled_(cancelled), on_first_look_(on_first_look) {}

    FittedModel run() {
        FittedModel fitted = fit();
        fitted.tried_seconds = tried_seconds_;
        return fitted;
    }

  private:
    FittedModel fit() {
        FittedModel fitted;
        DetailOptions options = options_;
        int steps_left = options.culls() ? most_coarser_steps : 0;
        make_anew(options, steps_left, fitted);
        fitted.whole_seconds = fitted.seconds;
        fitted.allowed_seconds = std::numeric_limits<double>::infinity();
        if (!options.culls()) return fitted;
        while (steps_left > 0 && too_much(fitted.seconds)) {
            const double steps = std::log(excess(fitted.seconds)) / std::log(most_gain);
            const double error_px = options.error_px * std::pow(coarser, std::max(std::ceil(steps), 1.0));
            if (error_px > most_before_samples * options_.error_px && share_ > least_share_) {
                share_ = std::max(share_ / excess(fitted.seconds), least_share_);
                fitted.samples_cut = true;
                continue;
            }
            fitted.work_cut = true;
            // Each look that is broken off takes much of the time there is: there are to be few.
            const int least = broken_looks_ < most_broken_looks ? 1 << broken_looks_ : most_coarser_steps;
            for (int i = 0; (i < least || i < steps) && (i == 0 || steps_left > 0); ++i)
                make_coarser(options, steps_left);
            std::vector<ShellSizes> shell_sizes = std::move(fitted.model->shell_sizes);
            fitted.model.reset();
            if (!make(std::move(shell_sizes), options, fitted)) {
                note_memory(options, steps_left, fitted);
                make_anew(options, steps_left, fitted);
            }
        }
        while (too_much(fitted.seconds) && fitted.model->most_visits > fewest_visits) {
            const std::uint64_t fewer = excess(fitted.seconds) > 4 ? 4 : 2;
            fitted.model->most_visits = std::max(fitted.model->most_visits / fewer, fewest_visits);
            fitted.work_cut = fitted.rays_cut = true;
            fitted.seconds = seconds_for(*fitted.model);
        }
        fitted.allowed_seconds = allowed();
        return fitted;
    }

    static void make_coarser(DetailOptions& options, int& steps_left) {
        --steps_left;
        options.error_px *= coarser;
        if (options.error_world) *options.error_world *= coarser;
    }

    void note_memory(DetailOptions& options, int& steps_left, FittedModel& fitted) {
        fitted.out_of_memory = true;
        if (steps_left == 0 || failed_seconds_ > work_seconds_) throw std::bad_alloc();
        for (int i = 0; i < steps_after_memory && steps_left > 0; ++i)
            make_coarser(options, steps_left);
    }

    /// As coarse as the memory asks for.
    void make_anew(DetailOptions& options, int& steps_left, FittedModel& fitted) {
        while (!make({}, options, fitted))
            note_memory(options, steps_left, fitted);
    }

    /// False where it takes more memory than there is.
    bool make(std::vector<ShellSizes> shell_sizes, const DetailOptions& options, FittedModel& fitted) {
        const std::uint64_t instances = prepared_->instances;
        work_seconds_ = work_beside_graph(options_.work_seconds, instances);
        slowness_ = slowness_of_graph(instances);
        try {
            fitted.model = std::make_unique<TraceModel>(prepared_, view_, options, textures_,
                                                        std::move(shell_sizes), self_shadow_store_);
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

    /// Trying and samples that meet nothing take their share, too; the rest keeps half in any case.
    double allowed() const {
        const double spent = tried_seconds_ + share_ * samples_ / WorkRates::samples;
        return std::max(work_seconds_ - spent, 0.5 * work_seconds_);
    }

    double excess(double seconds) const { return share_ * seconds / allowed(); }

    bool too_much(double seconds) const { return excess(seconds) > 1 && !cancelled_(); }

    static double shell_seconds(const TraceModel& model) {
        return static_cast<double>(model.meshes.shell_work()) / WorkRates::shell_points;
    }

    /// Each look is at more of the picture, until one finds too much.
    double seconds_for(TraceModel& model) {
        const auto pixels =
            static_cast<std::uint64_t>(view_.size.width) * static_cast<std::uint64_t>(view_.size.height);
        const std::uint64_t first = std::max(pixels / pixels_of_first_look, least_first_look);
        const std::uint64_t second = std::max(pixels / pixels_of_second_look, least_second_look);
        const std::uint64_t last = std::max(pixels / pixels_of_last_look, second);
        const int broken_before = broken_looks_;
        double seconds = look_briefly(model, first);
        if (!std::exchange(looked_, true) && on_first_look_) on_first_look_(model, seconds);
        if (broken_looks_ > broken_before || excess(seconds) > clear_factor) return seconds;
        PictureTracer tracer(model, limits_of_(model));
        for (std::uint64_t done = 0; done < last; done += second) {
            seconds = look_on(model, tracer, done, std::min(done + second, last));
            if (broken_looks_ > broken_before || too_much(seconds)) break;
        }
        return seconds;
    }

    /// Parts that each of so many rays may go into.
    std::uint64_t visits_of_first_look(std::uint64_t rays) const {
        const double steps = most_for_first_look * work_seconds_ * WorkRates::ray_steps / slowness_;
        const double visits = steps / (rays_a_look * steps_a_visit * static_cast<double>(rays));
        return static_cast<std::uint64_t>(std::clamp<double>(visits, fewest_visits, 1e9));
    }

    /// By rays that are given up early, and count as if they went on to the end.
    double look_briefly(TraceModel& model, std::uint64_t rays) {
        const std::uint64_t whole_visits = model.most_visits;
        if (options_.culls()) model.most_visits = std::min(whole_visits, visits_of_first_look(rays));
        const auto visits_left = static_cast<double>(whole_visits - model.most_visits);
        PictureTracer tracer(model, limits_of_(model));
        const double seconds = look_on(model, tracer, 0, rays);
        const double steps_left =
            static_cast<double>(tracer.statistics().given_up) * steps_a_visit * visits_left;
        model.most_visits = whole_visits;
        return seconds + steps_left * second_of_steps() * samples_ / static_cast<double>(rays);
    }

    /// What the picture takes by all rays that the tracer has tried, those from `begin` to `end` now.
    double look_on(TraceModel& model, PictureTracer& tracer, std::uint64_t begin, std::uint64_t end) {
        const double shells_before = shell_seconds(model);
        const std::uint64_t work_before = tracer.statistics().work;
        TraceControl control;
        control.threads = threads_;
        const double most_shells = most_for_shells * allowed();
        const auto too_many_shells = [&] { return options_.culls() && shell_seconds(model) > most_shells; };
        control.cancelled = [&] { return cancelled_() || too_many_shells(); };
        if (options_.culls())
            model.meshes.make_until(static_cast<std::uint64_t>(most_shells * WorkRates::shell_points));
        tracer.probe(begin, end, control);
        model.meshes.make_until(UINT64_MAX);
        if (too_many_shells()) { // how many there are by now depends on the threads
            tried_seconds_ += most_shells;
            ++broken_looks_;
            return broken_off * allowed() / share_;
        }
        const TraceStatistics& tried = tracer.statistics();
        const double shells = shell_seconds(model);
        tried_seconds_ +=
            second_of_steps() * static_cast<double>(tried.work - work_before) + shells - shells_before;
        return second_of_steps() * static_cast<double>(tried.work) * samples_ / static_cast<double>(end) +
               shells;
    }

    double second_of_steps() const { return slowness_ / WorkRates::ray_steps; }

    const std::shared_ptr<const PreparedCut> prepared_;
    const std::shared_ptr<SelfShadowStore> self_shadow_store_ = std::make_shared<SelfShadowStore>();
    const View& view_;
    const DetailOptions& options_;
    const ModelTextures& textures_;
    const double samples_, least_share_;
    double share_ = 1; ///< of the samples that are taken
    const std::function<ShaderLimits(const TraceModel&)>& limits_of_;
    const int threads_;
    const std::function<bool()>& cancelled_;
    const std::function<void(const TraceModel&, double)>& on_first_look_;
    bool looked_ = false;
    double work_seconds_ = 0;   ///< for the rays, and for what is tried
    double slowness_ = 1;       ///< of their steps
    double failed_seconds_ = 0; ///< that models took for which the memory did not suffice
    double tried_seconds_ = 0;  ///< that rays, shells and weights took
    int broken_looks_ = 0;
};

} // namespace

FittedModel fit_work(std::shared_ptr<const PreparedCut> prepared, const View& view,
                     const DetailOptions& options, const ModelTextures& textures, double samples_a_pixel,
                     double fewest_a_pixel, const std::function<ShaderLimits(const TraceModel&)>& limits_of,
                     int threads, const std::function<bool()>& cancelled,
                     const std::function<void(const TraceModel&, double)>& on_first_look) {
    return Fitting(std::move(prepared), view, options, textures, samples_a_pixel, fewest_a_pixel, limits_of,
                   threads, cancelled, on_first_look)
        .run();
}

} // namespace graftal
