#include "compiler/inst/lower_scatter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/graph/path.h"
#include "compiler/inst/scatter_points.h"
#include "compiler/lower/lower_area.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/support/number.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// The least share of an area that exceptions may leave: smaller shares are too few samples.
constexpr double least_share = 0.01;
constexpr double largest_seed = 9007199254740992; // 2^53

/// The uses of the random numbers of a scatter. Each use has a sequence of its own, so that a line more or
/// less leaves the numbers of other lines as they are.
enum Use : std::uint64_t { places, masters, turns, leans, lean_directions, sizes, first_tint };

struct Range {
    double from = 0, to = 0;

    double at(double t) const { return from + t * (to - from); }
};

/// Cosine and sine of an angle in turns, by additions and multiplications, which all machines round alike.
Vec2 on_circle(double turns) {
    const double quarter = std::floor(4 * turns + 0.5);
    const double x = (turns - quarter / 4) * 2 * std::numbers::pi, square = x * x;
    double cosine = 1, sine = 1;
    for (int k = 16; k > 0; k -= 2) {
        cosine = 1 - cosine * square / (k * (k - 1));
        sine = 1 - sine * square / (k * (k + 1));
    }
    const Vec2 v(cosine, x * sine);
    switch (static_cast<int>(quarter - 4 * std::floor(quarter / 4))) {
    case 0:
        return v;
    case 1:
        return {-v.y, v.x};
    case 2:
        return -v;
    default:
        return {v.y, -v.x};
    }
}

/// The right-handed rotation about a coordinate axis.
Mat3 rotation(int axis, double degrees) {
    const Vec2 v = on_circle(degrees / 360);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    Mat3 m(1.0);
    m[a][a] = m[b][b] = v.x;
    m[a][b] = v.y;
    m[b][a] = -v.y;
    return m;
}

class ScatterLowerer {
  public:
    ScatterLowerer(const InstGroup& group, const ScatterContext& context, Diagnostics& diagnostics)
        : group_(group), scatter_(*group.scatter), context_(context), diagnostics_(diagnostics), random_(0) {}

    void run(const ScatterTaker& taker) {
        if (!scatter_.complete) return;
        const std::size_t errors = diagnostics_.error_count();
        lower_seed();
        lower_numbers();
        lower_weights();
        lower_tints();
        const std::optional<ScatterArea> area = lower_areas();
        if (diagnostics_.error_count() > errors || !area) return;
        const std::optional<std::vector<Vec2>> points = choose_points(*area);
        if (!points) return;
        taker.begin(points->size());
        for (std::size_t i = 0; i < points->size(); ++i) {
            if (context_.meter) context_.meter->add(1, StagePrice::draw);
            taker.take(place(i, (*points)[i]));
        }
    }

  private:
    // Numbers

    /// A number for which `good` holds, else the error "'count' must ..., not -1".
    template<typename Predicate>
    std::optional<double> number(const std::optional<Expression>& expression, std::string_view keyword,
                                 const Predicate& good, std::string_view demand) {
        if (!expression) return std::nullopt;
        const std::optional<double> value = evaluate(*expression, context_.environment, diagnostics_);
        if (!value || good(*value)) return value;
        diagnostics_.error(expression->span,
                           fmt::format("'{}' must {}, not {}", keyword, demand, shortest(*value)));
        return std::nullopt;
    }

    template<typename Predicate>
    Range range(const std::optional<InstRange>& text, Range otherwise, std::string_view keyword,
                const Predicate& good, std::string_view demand) {
        if (!text) return otherwise;
        const std::optional<double> from = number(text->from, keyword, good, demand);
        const std::optional<double> to = text->to ? number(text->to, keyword, good, demand) : from;
        if (from && to && !std::isfinite(*to - *from))
            diagnostics_.error(text->span, fmt::format("the ends of this '{}' lie too far apart", keyword));
        return {from.value_or(otherwise.from), to.value_or(otherwise.to)};
    }

    void lower_seed() {
        const std::optional<double> seed = number(
            scatter_.seed, "seed", [](double x) { return x >= 0 && x <= largest_seed && x == std::floor(x); },
            "be a whole number of at least 0");
        const auto own = static_cast<std::uint64_t>(seed.value_or(static_cast<double>(scatter_.ordinal)));
        random_ = context_.seed ? CounterRandom(*context_.seed).sequence(own) : CounterRandom(own);
    }

    void lower_numbers() {
        const auto any = [](double) { return true; };
        turn_ = range(scatter_.turn, {}, "turn", any, "");
        lean_ = range(scatter_.lean, {}, "lean", any, "");
        if (scatter_.lean && !scatter_.lean->to) lean_.from = 0;
        size_ = range(
            scatter_.size, {1, 1}, "size", [](double x) { return x > 0; }, "be positive");
        apart_ = number(
            scatter_.apart, "apart", [](double x) { return x > 0; }, "be positive");
        count_ = number(
            scatter_.count, "count", [](double x) { return x >= 1 && x == std::floor(x); },
            "be a whole number of at least 1");
        if (count_ && *count_ > static_cast<double>(context_.most)) refuse_count();
        if (scatter_.apart && order() != ScatterOrder::poisson)
            diagnostics_.error(scatter_.apart->span, "only 'by: poisson' keeps places 'apart'");
        if (!scatter_.count && !scatter_.apart)
            diagnostics_.error(group_.span, "the number of instances is missing")
                .with_hint("give 'count: n', or 'apart: d' for as many as fit");
    }

    void refuse_count() {
        diagnostics_.error(scatter_.count->span,
                           fmt::format("'count' is {}, and the graph has room for {} more instances",
                                       shortest(*count_), context_.most));
    }

    ScatterOrder order() const { return scatter_.by.value_or(ScatterOrder::poisson); }

    void lower_weights() {
        if (scatter_.weights.empty()) return;
        if (scatter_.weights.size() != group_.masters.size()) {
            diagnostics_.error(scatter_.weights_span,
                               fmt::format("each object needs one weight: {} in all, not {}",
                                           group_.masters.size(), scatter_.weights.size()));
            return;
        }
        double sum = 0;
        for (const Expression& weight : scatter_.weights) {
            sum += number(
                       weight, "weights", [](double x) { return x >= 0; }, "not be negative")
                       .value_or(1);
            up_to_.push_back(sum);
        }
        if (!(sum > 0) || !std::isfinite(sum))
            diagnostics_.error(scatter_.weights_span, sum > 0 ? "the sum of these weights overflows"
                                                              : "one of these weights must be positive");
    }

    void lower_tints() {
        for (const InstTint& line : group_.tints) {
            const std::optional<Tint> from = lower_tint(line.values, context_.environment, diagnostics_);
            const std::optional<Tint> to =
                line.until.empty() ? from : lower_tint(line.until, context_.environment, diagnostics_);
            if (from && to) tints_.emplace_back(*from, *to);
        }
    }

    // Areas

    std::optional<ScatterArea> lower_areas() {
        ScatterArea area;
        bool good = true;
        for (const AreaText& text : scatter_.except) {
            const auto lowered = lower_area(text.numbers, text.span, context_.environment, diagnostics_);
            if (lowered) area.without.push_back(*lowered);
            good = good && lowered;
        }
        const std::optional<FlatArea> within = lower_over();
        if (!within || !good) return std::nullopt;
        area.within = *within;
        const double size = area.size(context_.meter);
        if (size >= least_share * within->size()) return area;
        diagnostics_
            .error(scatter_.over->span, size > 0 ? "the exceptions leave less than a hundredth of this area"
                                                 : "the exceptions leave nothing of this area")
            .with_note(scatter_.except.front().span, "this exception");
        return std::nullopt;
    }

    std::optional<FlatArea> lower_over() {
        if (!scatter_.over) {
            diagnostics_.error(group_.span, "the area of these instances is missing")
                .with_hint("give 'over: x0, z0, x1, z1', 'over: disc r' or 'over: ground'");
            return std::nullopt;
        }
        const AreaText& over = *scatter_.over;
        if (over.kind == AreaText::Kind::ground) return ground();
        return lower_area(over.numbers, over.span, context_.environment, diagnostics_);
    }

    /// The area of the ground; else what lies before the camera: the disc about the place that it looks at,
    /// through the place where it stands.
    std::optional<FlatArea> ground() {
        const SceneSettings& settings = context_.settings;
        if (settings.ground) height_ = settings.ground->height;
        if (settings.ground && settings.ground->area) return settings.ground->area;
        if (settings.camera && settings.camera->location && settings.camera->look_at) {
            const Vec3 from = *settings.camera->location, to = *settings.camera->look_at;
            const Vec2 centre(to.x, to.z);
            const FlatArea area = FlatArea::round(centre, glm::distance(Vec2(from.x, from.z), centre));
            if (area.size() > 0 && std::isfinite(area.size())) return area;
        }
        diagnostics_.error(scatter_.over->span, "the extent of the ground is missing")
            .with_hint("write 'ground { area: x0, z0, x1, z1 }' or 'ground { area: disc r }', or give the "
                       "camera a 'location' and a 'look_at'");
        return std::nullopt;
    }

    // Places

    std::optional<std::vector<Vec2>> choose_points(const ScatterArea& area) {
        const auto count = static_cast<std::size_t>(count_.value_or(static_cast<double>(context_.most) + 1));
        const double size = area.size(context_.meter);
        const double apart = apart_.value_or(loose_distance(size, count));
        // Where no more fit, the discs of this radius around the places cover the area.
        const double at_least = size / apart / apart / std::numbers::pi;
        if (!count_ && at_least > static_cast<double>(context_.most)) return refuse_fill();
        std::vector<Vec2> points = points_by_order(area, count, apart);
        if (count_ && points.size() < count) return refuse_places(points.size(), apart);
        if (points.size() > context_.most) return refuse_fill();
        return points;
    }

    std::nullopt_t refuse_fill() {
        diagnostics_
            .error(group_.span, fmt::format("more than {} places fit, and the graph has no room for more "
                                            "instances",
                                            context_.most))
            .with_hint("give a larger 'apart', or a 'count'");
        return std::nullopt;
    }

    std::vector<Vec2> points_by_order(const ScatterArea& area, std::size_t count, double apart) const {
        switch (order()) {
        case ScatterOrder::uniform:
            return uniform_points(area, count, random_.sequence(places), context_.meter);
        case ScatterOrder::jitter:
            return jittered_points(area, count, random_.sequence(places), context_.meter);
        case ScatterOrder::spiral:
            return spiral_points(area, count, context_.meter);
        case ScatterOrder::poisson:
            break;
        }
        return poisson_points(area, count, apart, random_.sequence(places), context_.meter);
    }

    std::nullopt_t refuse_places(std::size_t placed, double apart) {
        if (order() != ScatterOrder::poisson)
            diagnostics_.error(scatter_.count->span, "this pattern does not fit into the area")
                .with_hint("use smaller exceptions, or place the instances 'by: poisson'");
        else
            diagnostics_
                .error(scatter_.count->span, fmt::format("only {} of {} places fit {} apart", placed,
                                                         shortest(*count_), shortest(apart)))
                .with_hint("lower 'count' or 'apart', or give only one of them");
        return std::nullopt;
    }

    /// The i-th number of [0, 1) for one use.
    double draw(std::uint64_t use, std::size_t i) const {
        return CounterRandom::unit(random_.sequence(use)(i));
    }

    ScatteredPlace place(std::size_t i, Vec2 point) const {
        ScatteredPlace result;
        result.master = master(i);
        Mat3& linear = result.parent_from_child.linear;
        if (scatter_.turn) linear = rotation(scatter_.turn_axis, turn_.at(draw(turns, i)));
        if (scatter_.lean) linear = lean(i) * linear;
        linear *= size_.at(draw(sizes, i));
        result.parent_from_child.translation = {point.x, height_, point.y};
        std::vector<Tint> own;
        for (std::size_t k = 0; k < tints_.size(); ++k)
            own.push_back(tint(tints_[k], draw(first_tint + k, i)));
        result.tint = composed(own);
        return result;
    }

    std::size_t master(std::size_t i) const {
        const double t = draw(masters, i);
        if (up_to_.empty()) return static_cast<std::size_t>(t * static_cast<double>(group_.masters.size()));
        const auto found = std::upper_bound(up_to_.begin(), up_to_.end() - 1, t * up_to_.back());
        return static_cast<std::size_t>(found - up_to_.begin());
    }

    /// The lean of an instance, about a horizontal axis of any direction.
    Mat3 lean(std::size_t i) const {
        const double direction = 360 * draw(lean_directions, i);
        return rotation(1, direction) * rotation(0, lean_.at(draw(leans, i))) * rotation(1, -direction);
    }

    static Tint tint(const std::pair<Tint, Tint>& ends, double t) {
        if (ends.first == ends.second) return ends.first;
        return {glm::mix(ends.first.rgb, ends.second.rgb, t),
                ends.first.alpha + t * (ends.second.alpha - ends.first.alpha)};
    }

    const InstGroup& group_;
    const InstScatter& scatter_;
    const ScatterContext& context_;
    Diagnostics& diagnostics_;
    CounterRandom random_;

    std::optional<double> count_, apart_;
    Range turn_, lean_, size_;
    std::vector<double> up_to_; ///< sums of weights; none where all are alike
    std::vector<std::pair<Tint, Tint>> tints_;
    double height_ = 0; ///< of the plane
};

} // namespace

void lower_scatter(const InstGroup& group, const ScatterContext& context, const ScatterTaker& taker,
                   Diagnostics& diagnostics) {
    ScatterLowerer(group, context, diagnostics).run(taker);
}

Tint composed(const std::vector<Tint>& tints) {
    if (tints.empty()) return {};
    if (tints.size() == 1) return tints.front();
    PathTint path;
    for (const Tint& tint : tints)
        path = PathTint(tint) * path;
    return straight(path);
}

} // namespace graftal
