#include "runtime/fit/fit_work.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "compiler/detail/work.h"
#include "compiler/support/stage_price.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

namespace {

/// Rays of the first piece of a look, and the most rays of a piece for each ray before it. The last piece is
/// close, with a ray for each `pixels_a_ray` pixels. A hundredth of a picture may take all of the work; a
/// still smaller share is seldom met.
constexpr std::uint64_t first_piece = 16, growth_of_pieces = 4, pixels_a_ray = 16, least_last = 256;
/// Rays that are traced before a picture is drawn by what they took.
constexpr std::uint64_t rays_before_draft = 64;
/// Shares of the work: of a look, and of all looks; and seconds, for rays enough tell the price of a poster.
constexpr double most_for_a_look = 0.04, most_for_looks = 0.2, longest_look = 1, longest_looks = 5;
constexpr double steps_a_visit = 2 * RayWork::part;
/// The growth of the error from one try to the next: less for the first tries.
constexpr double coarser = 1.5;
constexpr int small_tries = 2;
constexpr double coarsest = 57; ///< of errors, as a multiple of the one asked for
/// A larger error that saves less is of no use: octaves of work for an octave of error.
constexpr double least_gain = 0.75;
/// Errors looked at between two tries.
constexpr int steps_between = 8;
/// All is made anew after the memory did not suffice: few tries must do.
const double coarser_after_memory = std::pow(coarser, 3);
constexpr std::uint64_t fewest_visits = 16;
/// The share of the allowed work that shells may take: a look that takes more is broken off, as the picture
/// would take more, too. Such a look counts as `broken_off` times the allowed work.
constexpr double most_for_shells = 0.5, broken_off = 4;
/// Number of broken looks after which the picture is made as coarse as may be.
constexpr int most_broken_looks = 2;

/// The price of a model, in seconds of one processor.
struct Price {
    double sample = 0; ///< one for each pixel of the picture
    double fixed = 0;  ///< the shells that its rays meet
    bool known = true; ///< else it was too much to be measured

    double of(double samples) const { return fixed + samples * sample; }
};

/// The price at `share` of the way from one error to another.
Price between(const Price& a, const Price& b, double share) {
    const auto mean = [share](double x, double y) {
        return x > 0 && y > 0 ? std::exp(std::lerp(std::log(x), std::log(y), share)) : std::lerp(x, y, share);
    };
    return {mean(a.sample, b.sample), mean(a.fixed, b.fixed), a.known && b.known};
}

class Fitting {
  public:
    explicit Fitting(FitRequest request)
        : ask_(std::move(request)), cancel_(ask_.cancelled),
          pixels_(static_cast<double>(ask_.view.size.width) * ask_.view.size.height),
          work_seconds_(work_after_stages(ask_.options.work_seconds, ask_.prepared->work_seconds)),
          slowness_(slowness_of_graph(ask_.prepared->instances)) {}

    FittedModel run() {
        fit();
        fitted_.error_px = fitted_.model->options.error_px;
        fitted_.sample_seconds = price_.sample;
        fitted_.seconds = seconds_of(price_, fitted_.sampling);
        fitted_.tried_seconds = tried_seconds_;
        return std::move(fitted_);
    }

  private:
    /// An error, as a multiple of the one asked for, and what would come of it.
    struct Choice {
        double factor = 1;
        Sampling sampling;
        double loss = std::numeric_limits<double>::infinity();
    };

    void fit() {
        make_anew(1);
        fitted_.sampling = ask_.wanted;
        fitted_.whole_seconds = seconds_of(price_, ask_.wanted);
        if (!ask_.options.culls() || fits(ask_.wanted)) return;
        const Price price_asked = price_;
        const Choice best = best_choice();
        if (best.factor != factor_)
            make_anew(best.factor, best.factor == 1 ? std::optional(price_asked) : std::nullopt);
        fitted_.sampling = affordable(price_);
        if (is_almost_affordable(best.sampling)) fitted_.sampling = best.sampling;
        while (price_.known && !fits(fitted_.sampling) && !is_almost_affordable(fitted_.sampling) &&
               fitted_.model->most_visits > fewest_visits) {
            const std::uint64_t fewer = seconds_of(price_, fitted_.sampling) > 4 * allowed() ? 4 : 2;
            fitted_.model->most_visits = std::max(fitted_.model->most_visits / fewer, fewest_visits);
            fitted_.rays_cut = true;
            price_ = look(*fitted_.model);
        }
    }

    bool fits(const Sampling& sampling) const {
        return price_.known && seconds_of(price_, sampling) <= allowed();
    }

    /// Tries take of the work while a choice is made; a fourth of the samples for the last of them would be a
    /// bad bargain.
    bool is_almost_affordable(const Sampling& sampling) const {
        constexpr double overdraft = 1.2;
        return price_.known && tried_seconds_ + seconds_of(price_, sampling) <= overdraft * work_seconds_;
    }

    /// Tries larger and larger errors, as long as they may still win.
    Choice best_choice() {
        Choice best = choice(factor_, price_);
        for (int tries = 1; factor_ < coarsest; ++tries) {
            if (!(std::log2(factor_ * coarser) < best.loss)) break;
            if (tried_seconds_ > seconds_of_looks() && best.loss < infinite_loss) break;
            const double factor_before = factor_;
            const Price price_before = price_;
            make_anew(factor_ * next_step(tries));
            if (best.loss < infinite_loss && gain(price_before, factor_ / factor_before) < least_gain) break;
            for (int i = 1; i <= steps_between; ++i) {
                const double share = static_cast<double>(i) / steps_between;
                const Choice next =
                    choice(std::exp(std::lerp(std::log(factor_before), std::log(factor_), share)),
                           between(price_before, price_, share));
                if (next.loss < best.loss) best = next;
            }
        }
        if (!(best.loss < infinite_loss)) best.factor = factor_;
        return best;
    }

    /// Octaves of work that an octave of error saves.
    double gain(const Price& before, double step) const {
        const double samples = ask_.wanted.samples_a_pixel();
        return price_.known ? std::log2(before.of(samples) / price_.of(samples)) / std::log2(step) : 1;
    }

    double next_step(int tries) const {
        const bool nothing_left = tried_seconds_ > work_seconds_;
        if (nothing_left || broken_looks_ >= most_broken_looks) return std::max(coarsest / factor_, coarser);
        if (tried_seconds_ > seconds_of_looks()) return coarser * coarser * coarser;
        return tries <= small_tries && broken_looks_ == 0 ? coarser : coarser * coarser;
    }

    Choice choice(double factor, const Price& price) const {
        Choice made{factor, affordable(price), infinite_loss};
        if (price.known && seconds_of(price, made.sampling) <= allowed())
            made.loss = std::log2(factor) + loss_of_samples(ask_.wanted, made.sampling);
        return made;
    }

    /// The denoiser has a price of its own, whatever the model.
    double denoising_seconds(const Sampling& sampling) const {
        return sampling.feature_rays() > 0 ? pixels_ / WorkRates::denoised_pixels : 0;
    }

    double seconds_of(const Price& price, const Sampling& sampling) const {
        return price.of(sampling.cost_in_samples()) + denoising_seconds(sampling);
    }

    Sampling affordable(const Price& price) const {
        const auto within = [&](const Sampling& wanted) {
            const double seconds = allowed() - denoising_seconds(wanted) - price.fixed;
            return affordable_sampling(
                wanted, price.known ? std::max(seconds, 0.0) / std::max(price.sample, 1e-12) : 0);
        };
        const Sampling denoised = within(ask_.wanted);
        if (denoised.denoise || !ask_.wanted.denoise) return denoised;
        Sampling noisy = ask_.wanted;
        noisy.denoise = false;
        return within(noisy);
    }

    /// A model of this error, whose price may be known, or of the smallest larger one for which the memory
    /// suffices.
    void make_anew(double factor, const std::optional<Price>& known = {}) {
        fitted_.model.reset();
        while (!make(factor, known)) {
            fitted_.out_of_memory = true;
            if (!ask_.options.culls() || factor >= coarsest || failed_seconds_ > work_seconds_)
                throw std::bad_alloc();
            factor *= coarser_after_memory;
        }
    }

    /// False where it takes more memory than there is.
    bool make(double factor, const std::optional<Price>& known) {
        DetailOptions options = ask_.options;
        options.error_px *= factor;
        if (options.error_world) *options.error_world *= factor;
        try {
            if (!basis_) {
                basis_ = ask_.basis
                             ? ask_.basis
                             : std::make_shared<TraceBasis>(*ask_.prepared, options.work_seconds, cancel_);
                tried_seconds_ += StagePrice::piece * static_cast<double>(basis_->bounds.pieces);
            }
            fitted_.model = std::make_unique<TraceModel>(ask_.prepared, ask_.view, options, ask_.textures,
                                                         basis_, cancel_);
            tried_seconds_ +=
                slowness_ * (static_cast<double>(fitted_.model->weighed) / WorkRates::kinds +
                             static_cast<double>(fitted_.model->edges.size()) / WorkRates::trace_edges);
            measure_self_shadows();
            factor_ = factor;
            price_ = known ? *known : look(*fitted_.model);
            return true;
        } catch (const std::bad_alloc&) {
            fitted_.model.reset();
            failed_seconds_ += static_cast<double>(ask_.prepared->instances) / WorkRates::trace_edges;
            return false;
        }
    }

    /// Before somebody asks, so that the work does not depend on who does.
    void measure_self_shadows() {
        if (measured_ || !(fitted_.model->projection.error_px() > SelfShadows::lit_as_px)) return;
        measured_ = true;
        tried_seconds_ +=
            static_cast<double>(fitted_.model->self_shadows(cancel_).work()) / WorkRates::parts_gone_by;
    }

    /// The work that trying has left: half in any case.
    double allowed() const { return std::max(work_seconds_ - tried_seconds_, 0.5 * work_seconds_); }

    static double shell_seconds(const TraceModel& model) {
        return static_cast<double>(model.meshes.shell_work()) / WorkRates::shell_points;
    }

    double second_of_steps() const { return slowness_ / WorkRates::ray_steps; }

    double seconds_of_looks() const { return std::min(most_for_looks * work_seconds_, longest_looks); }

    /// Steps that a look may take.
    double steps_of_a_look() const {
        return std::min(most_for_a_look * work_seconds_, longest_look) / second_of_steps();
    }

    /// Traces rays all over the picture, piece by piece, until the steps of a look are spent. A ray that
    /// would go on for longer than they allow is given up, and counts as if it went on to the end.
    Price look(TraceModel& model) {
        const auto last = std::max(static_cast<std::uint64_t>(pixels_) / pixels_a_ray, least_last);
        const std::uint64_t whole_visits = model.most_visits;
        const double most_steps = steps_of_a_look();
        if (ask_.options.culls()) {
            const double most_visits = most_steps / (steps_a_visit * first_piece);
            model.most_visits =
                std::min(whole_visits,
                         std::max(static_cast<std::uint64_t>(std::min(most_visits, 1e9)), fewest_visits));
        }
        PictureTracer tracer(model, ask_.limits_of(model));
        Price price;
        std::uint64_t rays = 0;
        while (rays < last && price.known) {
            const double spent = static_cast<double>(tracer.statistics().work);
            std::uint64_t piece = first_piece;
            if (rays > 0) {
                const double affordable = static_cast<double>(rays) * (most_steps / std::max(spent, 1.0) - 1);
                if (affordable < first_piece) break;
                piece =
                    std::min(growth_of_pieces * rays, static_cast<std::uint64_t>(std::min(affordable, 1e9)));
            }
            piece = std::min(piece, last - rays);
            price.known = look_on(model, tracer, rays, rays + piece);
            rays += piece;
            price.sample = sample_seconds(tracer, rays, whole_visits - model.most_visits);
            price.fixed = shell_seconds(model);
            if (rays >= rays_before_draft || rays >= last) draft(model, whole_visits, price.sample);
        }
        draft(model, whole_visits, price.sample);
        model.most_visits = whole_visits;
        // A look that is broken off has seen what its threads came to.
        return price.known ? price : Price{0, broken_off * allowed(), false};
    }

    void draft(TraceModel& model, std::uint64_t whole_visits, double seconds) {
        if (std::exchange(drafted_, true) || !ask_.on_first_look) return;
        const std::uint64_t visits = std::exchange(model.most_visits, whole_visits);
        ask_.on_first_look(model, seconds);
        model.most_visits = visits;
    }

    double sample_seconds(const PictureTracer& tracer, std::uint64_t rays, std::uint64_t visits_left) const {
        const TraceStatistics& tried = tracer.statistics();
        const double steps = static_cast<double>(tried.work) + steps_a_visit *
                                                                   static_cast<double>(tried.given_up) *
                                                                   static_cast<double>(visits_left);
        return pixels_ * (steps * second_of_steps() / static_cast<double>(rays) + 1 / WorkRates::samples);
    }

    /// Traces the rays from `begin` to `end`. False if they met more shells than there is work for.
    bool look_on(TraceModel& model, PictureTracer& tracer, std::uint64_t begin, std::uint64_t end) {
        const double shells_before = shell_seconds(model);
        const std::uint64_t work_before = tracer.statistics().work;
        TraceControl control;
        control.workers = ask_.workers;
        const double most_shells = most_for_shells * allowed();
        const auto too_many_shells = [&] {
            return ask_.options.culls() && shell_seconds(model) > most_shells;
        };
        control.cancelled = [&] { return cancel_.raised() || too_many_shells(); };
        control.for_good = cancel_;
        if (ask_.options.culls())
            model.meshes.make_until(static_cast<std::uint64_t>(most_shells * WorkRates::shell_points));
        tracer.probe(begin, end, control);
        if (cancel_.raised()) throw Cancelled();
        model.meshes.make_until(UINT64_MAX);
        if (too_many_shells()) { // how many there are by now depends on the threads
            tried_seconds_ += most_shells;
            ++broken_looks_;
            return false;
        }
        tried_seconds_ += second_of_steps() * static_cast<double>(tracer.statistics().work - work_before) +
                          shell_seconds(model) - shells_before;
        return true;
    }

    static constexpr double infinite_loss = std::numeric_limits<double>::infinity();

    FitRequest ask_;
    const CancelFlag cancel_;
    const double pixels_;
    const double work_seconds_; ///< for the rays, and for what is tried
    const double slowness_;     ///< of their steps
    std::shared_ptr<TraceBasis> basis_;
    bool measured_ = false; ///< the shadows of the basis
    FittedModel fitted_;
    Price price_;       ///< of the model
    double factor_ = 1; ///< of its error
    bool drafted_ = false;
    double failed_seconds_ = 0; ///< of models that ran out of memory
    double tried_seconds_ = 0;  ///< of rays, shells and weights
    int broken_looks_ = 0;
};

} // namespace

std::optional<FittedModel> fit_work(FitRequest request) {
    try {
        return Fitting(std::move(request)).run();
    } catch (const Cancelled&) {
        return std::nullopt;
    }
}

} // namespace graftal
