#include "compiler/povray/cut/cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/prepare.h"
#include "compiler/detail/self_shadow.h"
#include "compiler/detail/shadow/coverage.h"
#include "compiler/detail/work.h"
#include "compiler/povray/costs.h"
#include "compiler/povray/cut/assemble.h"
#include "compiler/povray/cut/calibrate.h"
#include "compiler/povray/cut/choose.h"

namespace graftal {

namespace {

/// The error grows by this where the memory does not suffice: a quarter less on each side of a leaf.
constexpr double coarser = 1.25;
/// Bytes fall about by this power of the error.
constexpr double bytes_by_error = 2;
/// A cut is tried that is estimated to take this much more than there is: what is assembled is then counted.
constexpr double estimate_slack = 1.25;
/// Share of the memory that may be spent to make POV-Ray faster.
constexpr double share_of_memory = 0.6;

/// Pieces after which the control is asked: some milliseconds.
constexpr std::uint64_t pieces_a_look = 10'000;

/// Share of the allowed work for graftal itself: the rest is for the rays.
constexpr double share_of_work = 0.75;

/// Share of the work with which the coarsest cut is still tried.
constexpr double least_share_of_work = 0.01;

std::string readable_count(double count) {
    if (!std::isfinite(count)) return "more than 1e308";
    return count < 1e15 ? fmt::format("{:.0f}", count) : fmt::format("{:.3g}", count);
}

class Cutter {
  public:
    Cutter(const Graph& graph, const PreparedGraph& prepared, const View& view, const DetailOptions& options,
           const CutOptions& cut_options, Diagnostics& diagnostics, const Control& control)
        : graph_(graph), view_(view), options_(options), cut_options_(cut_options),
          flattens_(cut_options.flatten || first_combined(graph) < graph.objects.size()),
          diagnostics_(diagnostics), prepared_(prepared), cut_(prepared_.cut), symmetry_(prepared_.symmetry),
          meter_(control, "cut", pieces_a_look) {}

    std::optional<Cut> run() {
        // Pictures that cull nothing have no coarser form.
        work_seconds_left_ =
            culls() ? share_of_work * work_after_stages(options_.work_seconds, prepared_.work_seconds)
                    : std::numeric_limits<double>::infinity();
        cube_triangles_ = visible_cube_triangles(cut_, symmetry_, prepared_.root_steps);
        if (std::optional<Cut> cut = attempt(0)) return finish(std::move(*cut), 0);
        if (!culls()) return refuse_size();
        // The finest that the memory allows: upwards by doubling, then halfway between what fails and what
        // does not.
        int fails = 0, next = coarser_than(0);
        std::optional<Cut> best;
        double cost = 0; // of the best
        const auto tried = [&](int steps) {
            const double before = work_seconds_left_;
            best.reset(); // two cuts of this size would take more memory than POV-Ray itself
            best = attempt(steps);
            if (best) cost = before - work_seconds_left_;
            return best.has_value();
        };
        while (!best && fails < coarsest()) {
            if (work_seconds_left_ < least_share_of_work * options_.work_seconds) {
                work_seconds_left_ = least_share_of_work * options_.work_seconds;
                next = coarsest();
            }
            next = std::min(next, coarsest());
            if (!tried(next)) fails = next;
            if (!best) next = coarser_than(next);
        }
        if (!best) return refuse_size();
        int fits = next;
        // A try takes no more than half of what is left: the best can be made again.
        while (fits - fails > 1 && work_seconds_left_ > 2 * cost) {
            const int half = (fails + fits) / 2;
            (tried(half) ? fits : fails) = half;
        }
        if (!best) {
            work_seconds_left_ = std::numeric_limits<double>::infinity(); // the work was not too much before
            best = attempt(fits);
        }
        if (!best) return refuse_size();
        return finish(std::move(*best), fits);
    }

  private:
    bool culls() const { return options_.culls(); }

    /// Steps of the error beyond what the whole picture measures, or a model in any unit.
    int coarsest() const {
        if (options_.error_world) return 124;
        const double picture = 4.0 * std::max(view_.size.width, view_.size.height);
        return std::max(0, static_cast<int>(std::log(picture / options_.error_px) / std::log(coarser)));
    }

    /// The step to try after one that failed. Where it failed for its work there is half as much for the
    /// next, and a step or two would not do. Where it is known how much it takes, that tells how many would.
    int coarser_than(int steps) const {
        if (failed_by_work_) return 2 * steps + 2;
        const double excess = needed_bytes_ / memory_for_scene();
        const double more =
            excess > 1 && std::isfinite(excess) ? std::log(excess) / (bytes_by_error * std::log(coarser)) : 0;
        return std::max({1, 2 * steps, steps + static_cast<int>(std::min<double>(more, coarsest()))});
    }

    /// Growth of the error after a number of steps.
    static double factor_after(int steps) { return std::pow(coarser, steps); }

    /// The cut with an error that is coarser by this number of steps than asked for. Nothing if it takes too
    /// much memory, POV-Ray's or our own.
    std::optional<Cut> attempt(int coarser_steps) {
        needed_bytes_ = 0;
        try {
            return attempt_within(coarser_steps);
        } catch (const std::bad_alloc&) {
            failed_by_work_ = false;
            return std::nullopt;
        }
    }

    std::optional<Cut> attempt_within(int coarser_steps) {
        DetailOptions options = options_;
        const double error_px = options_.error_px * factor_after(coarser_steps);
        if (options.error_world) options.error_world = *options_.error_world * factor_after(coarser_steps);
        const Projection projection(view_, options, error_px, nearest_to_eye(cut_));
        Piece root;
        root.node = cut_.root;
        root.steps = prepared_.root_steps;
        const Ball whole_ball = world_ball(cut_, root);
        const double px = projection.pixels_per_unit(whole_ball) / projection.detail_per_unit(whole_ball);
        Weights weights(cut_, {.leaf_price = povray_leaf_bytes,
                               .cube_triangles = cube_triangles_,
                               .px = px,
                               .error_px = projection.error_px(),
                               .grain = grain_,
                               .most_visits = visits_of_kinds()});
        const double memory = memory_for_scene();
        const Weights::Weight weight = weight_of(cut_, projection, weights, root);
        const std::uint64_t weighed = weights.visits();
        spend(seconds_of_kinds(weighed));
        if (flattens_ || better_flat(weight, memory)) {
            choice_ = flat_choice(weight);
            choice_.spelt_out = flattens_;
            std::optional<Cut> cut = assembled(root, projection, weights, memory);
            if (cut || flattens_) return cut;
        }
        choice_ = choose_cut(cut_, symmetry_, projection, root, weights, share_of_memory * memory, &meter_);
        spend(seconds_of_kinds(weights.visits() - weighed) + choice_.pieces / WorkRates::pieces);
        return assembled(root, projection, weights, memory);
    }

    /// The cut by the choice, if it fits.
    std::optional<Cut> assembled(const Piece& root, const Projection& projection, Weights& weights,
                                 double memory) {
        grain_ = weights.grain();
        const auto failed = [&](bool by_work) {
            failed_by_work_ = by_work;
            return std::nullopt;
        };
        needed_bytes_ = choice_.bytes;
        if (!(choice_.bytes <= estimate_slack * memory)) return failed(false);
        // The last try still has half of the work that is left.
        const double work_seconds = 0.5 * work_seconds_left_;
        AssemblyLimits limits{memory, work_seconds, slowness_of_graph(prepared_.instances), &meter_};
        std::optional<Cut> cut =
            assemble(cut_, symmetry_, projection, root, choice_, weights, limit_normals(), *prepared_.shells,
                     limits, self_shadows(projection));
        if (options_.culls()) work_seconds_left_ -= work_seconds - std::max(0.0, limits.work_seconds);
        needed_bytes_ = std::max(needed_bytes_, limits.needed_bytes);
        if (!cut) return failed(limits.work_seconds < 0);
        const double bytes = povray_bytes(*cut);
        cut->estimated_bytes = static_cast<std::uint64_t>(bytes + picture_bytes());
        if (bytes <= memory) return cut;
        needed_bytes_ = choice_.bytes = bytes;
        return failed(false);
    }

    bool limit_normals() const { return options_.limit_normals && !flattens_; }

    /// Null where all that is culled shows its own light.
    const SelfShadows* self_shadows(const Projection& projection) {
        if (!(projection.error_px() > SelfShadows::lit_as_px)) return nullptr;
        return &self_shadows_.get([this] {
            return measure_self_shadows(cut_, symmetry_, prepared_.root_steps, view_, limit_normals(),
                                        options_.light_steps, self_shadow_work(options_.work_seconds));
        });
    }

    void spend(double seconds) { work_seconds_left_ = std::max(0.0, work_seconds_left_ - seconds); }

    double seconds_of_kinds(std::uint64_t visits) const {
        return slowness_of_graph(prepared_.instances) * static_cast<double>(visits) / WorkRates::kinds;
    }

    /// Kinds are told apart as finely as this share of the work allows.
    std::uint64_t visits_of_kinds() const {
        constexpr double share = 0.1;
        const double seconds = share * options_.work_seconds / slowness_of_graph(prepared_.instances);
        return static_cast<std::uint64_t>(
            std::min(seconds * WorkRates::kinds, static_cast<double>(WeightOptions::usual_visits)));
    }

    static Choice flat_choice(const Weights::Weight& whole) {
        Choice choice;
        choice.leaves = whole.leaves;
        choice.placements = whole.leaves;
        choice.bytes = PovrayCosts::base + whole.flat_bytes;
        return choice;
    }

    double picture_bytes() const {
        return PovrayCosts::pixel * static_cast<double>(view_.size.width) * view_.size.height;
    }
    double memory_for_scene() const { return static_cast<double>(options_.memory_bytes) - picture_bytes(); }

    /// Twigs, leaves and balls are best spelt out where they are few enough: they are drawn exactly, and
    /// POV-Ray traces them several times as fast as their meshes in boxes that overlap.
    static bool better_flat(const Weights::Weight& whole, double memory) {
        constexpr double share_of_leaves = 0.125;
        return flat_choice(whole).bytes <= share_of_memory * memory &&
               whole.curved_leaves > share_of_leaves * whole.leaves;
    }

    Cut finish(Cut cut, int coarser_steps) {
        cut.error_asked_px =
            options_.error_world ? *options_.error_world * root_pixels_per_unit() : options_.error_px;
        const double unit_px = cut.error_asked_px * factor_after(coarser_steps);
        cut.error_px *= unit_px;
        if (cut.error_px > 0) note_shadowless(cut_, graph_, diagnostics_);
        constexpr double step_of_details = 1.5; // one mesh serves sizes of about an octave
        const Span& root = graph_.objects[graph_.root].span;
        const CoarserError error{std::max(unit_px, cut.error_px), cut.error_asked_px};
        if (coarser_steps > 0)
            warn_of_limit(root, passed_limit(), error, diagnostics_);
        else if (cut.error_px > step_of_details * unit_px)
            warn_of_shells(root, error, diagnostics_);
        return cut;
    }

    Limit passed_limit() const {
        Limit limit =
            failed_by_work_ ? limit_of_work(options_.work_seconds) : limit_of_memory(options_.memory_bytes);
        if (!options_.visible_only && reaches_out_of_sight())
            limit.or_else = ", leave out invisible parts with --visible-only";
        return limit;
    }

    /// Whether some of it only throws shadows into the picture, or is reflected there.
    bool reaches_out_of_sight() const {
        const Projection projection(view_, options_, 1, nearest_to_eye(cut_));
        for (int corner = 0; corner < 8; ++corner) {
            Vec3 point;
            for (int axis = 0; axis < 3; ++axis)
                point[axis] = (corner >> axis & 1 ? prepared_.bounds.max : prepared_.bounds.min)[axis];
            if (!projection.sees({point, 0})) return true;
        }
        return false;
    }

    double root_pixels_per_unit() const {
        return Projection(view_, options_, 1, nearest_to_eye(cut_))
            .pixels_per_unit(cut_.nodes[cut_.root].ball);
    }

    std::nullopt_t refuse_size() {
        if (failed_by_work_) {
            diagnostics_
                .error(graph_.objects[graph_.root].span,
                       fmt::format(
                           "{} primitives take more than the {:g} seconds of work allowed, even drawn as "
                           "coarsely as possible",
                           readable_count(choice_.leaves), options_.work_seconds))
                .with_hint("allow more with --work, lower --steps, or use '--engine native'");
            return std::nullopt;
        }
        const auto memory = static_cast<double>(options_.memory_bytes);
        // Where the estimate fitted but what was unfolded did not, nobody knows how much it would have been.
        std::string need;
        if (std::isfinite(choice_.bytes) && choice_.bytes + picture_bytes() > memory)
            need = "about " + readable_bytes(choice_.bytes + picture_bytes()) + " in POV-Ray, ";
        diagnostics_
            .error(graph_.objects[graph_.root].span,
                   fmt::format("{} primitives need {}more than the {} allowed",
                               readable_count(choice_.leaves), need, readable_bytes(memory)))
            .with_hint(
                cut_options_.flatten
                    ? "drop --flatten, leave out small parts with --error, lower --steps, or allow more with "
                      "--memory"
                    : "leave out small parts with --error, lower --steps, or allow more with --memory");
        return std::nullopt;
    }

    const Graph& graph_;
    const View& view_;
    const DetailOptions& options_;
    const CutOptions& cut_options_;
    /// Operands need it: POV-Ray tells what lies in a primitive, and not in a mesh that many are baked into.
    const bool flattens_;
    Diagnostics& diagnostics_;
    const PreparedGraph& prepared_;
    const DetailGraph& cut_;
    const Symmetry& symmetry_;
    double cube_triangles_ = 0; ///< visible_cube_triangles(), whatever the error
    int grain_ = 1;             ///< of the last weights
    SelfShadowStore self_shadows_;
    double work_seconds_left_ = 0;
    double needed_bytes_ = 0;     ///< by the last try, about, as far as it came; 0: not known
    WorkMeter meter_;             ///< of pieces that are chosen and unfolded, in all tries
    bool failed_by_work_ = false; ///< the last try that failed ended for its work
    Choice choice_;
};

} // namespace

std::optional<Cut> cut_prepared(const Graph& graph, const PreparedGraph& prepared, const View& view,
                                const DetailOptions& detail, Diagnostics& diagnostics,
                                const CutOptions& options, const Control& control) {
    return Cutter(graph, prepared, view, detail, options, diagnostics, control).run();
}

} // namespace graftal
