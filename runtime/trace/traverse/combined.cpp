// Rays through intersections and differences. A ray is asked of each operand where it is inside, where it
// leaves what it is in, and where it enters next. An operand is a union of parts that may overlap: it is left
// where no part is left that holds the point (Gervautz and Traxler, "Representation and realistic rendering
// of natural phenomena with cyclic CSG graphs", 1996, combine the same lists of intervals, whole).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/trace/traverse/traversal.h"

namespace graftal {

/// A place where a ray goes into the object or out of it.
struct Traversal::Boundary {
    double t = 0;
    Best best;
    std::vector<std::uint32_t> way; ///< from the object's frame on
};

/// The operands of one object as a ray asks for them, in groups: all that a difference takes away is one.
class Traversal::Operands {
  public:
    /// `frame`: of the object.
    Operands(Traversal& inner, const Ray& ray, const Frame& frame)
        : inner_(inner), ray_(ray), frame_(frame), node_(inner.model_.nodes[frame.node]),
          first_(node_.first_edge + (frame.cut ? node_.edge_count : 0)),
          end_(first_ + (frame.cut ? node_.stop_edge_count : node_.edge_count)) {}

    /// Whether the point just after t lies in the object.
    bool holds(double t) {
        if (node_.combination == Combination::subtract) return within(0, t) && !within(1, t);
        for (std::uint32_t group = 0; group < groups(); ++group)
            if (!within(group, t)) return false;
        return true;
    }

    /// Where the ray leaves the object. Requires holds(t).
    std::optional<Boundary> leave(double t, double most) {
        std::optional<Boundary> first;
        const auto take = [&](std::optional<Boundary> other) {
            if (other && other->t < most) {
                most = other->t;
                first = std::move(other);
            }
        };
        take(leave_group(0, t, most));
        if (node_.combination == Combination::subtract) {
            if (end_ - first_ > 1) take(inverted(enter_group(1, t, most)));
            return first;
        }
        for (std::uint32_t group = 1; group < groups(); ++group)
            take(leave_group(group, t, most));
        return first;
    }

    /// Where the ray enters the object next. Requires !holds(t).
    std::optional<Boundary> enter(double t, double most) {
        return node_.combination == Combination::subtract ? enter_difference(t, most)
                                                          : enter_intersection(t, most);
    }

  private:
    /// Distance within which boundaries count as one place, as a share of the object's half size. So faces
    /// that coincide leave no skin: a difference takes its face away.
    static constexpr double same_place = 1e-9;

    bool is_out_of_visits() const { return inner_.visits_ > inner_.visit_limit_; }

    std::uint32_t groups() const { return node_.combination == Combination::subtract ? 2 : end_ - first_; }

    bool ask(Search search, std::uint32_t group, double t, double most) {
        constexpr double rounding = 1e-15;
        const double least = t + std::max(same_place * frame_.unit, rounding * std::abs(t));
        inner_.more_work_ += RayWork::asked;
        inner_.search_ = search;
        inner_.leaves_ = least;
        const RayRange range{least, most};
        if (group == 0 || node_.combination == Combination::intersect)
            return inner_.ask_operands(ray_, frame_, first_ + group, first_ + group + 1, no_tree, range);
        return inner_.ask_operands(ray_, frame_, first_ + 1, end_, frame_.cut ? node_.stop_tree : node_.tree,
                                   range);
    }

    bool within(std::uint32_t group, double t) { return ask(Search::inside, group, t, INFINITY); }

    Boundary found(double t) const { return {t, inner_.best_, inner_.way_}; }

    std::optional<Boundary> enter_group(std::uint32_t group, double t, double most) {
        if (!ask(Search::entry, group, t, most)) return std::nullopt;
        return found(inner_.best_.t);
    }

    /// From part to part, as long as one holds the place where the last one ends. Nothing if the ray is
    /// outside, and if it leaves at `most` or later.
    std::optional<Boundary> leave_group(std::uint32_t group, double t, double most) {
        std::optional<Boundary> last;
        while (t < most && within(group, t)) {
            t = inner_.leaves_;
            last = found(t);
            if (is_out_of_visits()) return std::nullopt;
        }
        return t < most ? std::move(last) : std::nullopt;
    }

    static std::optional<Boundary> inverted(std::optional<Boundary> boundary) {
        if (boundary) boundary->best.inverted = !boundary->best.inverted;
        return boundary;
    }

    std::optional<Boundary> enter_difference(double t, double most) {
        std::optional<Boundary> at;
        while (!is_out_of_visits()) {
            if (!within(0, t)) {
                at = enter_group(0, t, most);
                if (!at) return at;
                t = at->t;
            }
            if (end_ - first_ < 2 || !within(1, t)) return at;
            at = inverted(leave_group(1, t, most));
            if (!at) return at;
            t = at->t;
            if (within(0, t)) return at;
        }
        return std::nullopt;
    }

    std::optional<Boundary> enter_intersection(double t, double most) {
        std::optional<Boundary> at;
        // Counts groups, one after the other, that hold the point.
        for (std::uint32_t group = 0, holding = 0; holding < groups(); group = (group + 1) % groups()) {
            if (is_out_of_visits()) return std::nullopt;
            if (within(group, t)) {
                ++holding;
                continue;
            }
            at = enter_group(group, t, most);
            if (!at) return at;
            t = at->t;
            holding = 1;
        }
        return at;
    }

    Traversal& inner_;
    const Ray& ray_;
    const Frame& frame_;
    const TraceNode& node_;
    const std::uint32_t first_, end_;
};

bool Traversal::meet_combined(std::uint32_t frame_number, const RayRange& range) {
    if (!inner_) inner_ = std::make_unique<Traversal>(model_, instructions_);
    const std::uint64_t visits = inner_->visits_, boxes = inner_->boxes_, more = inner_->more_work_;
    inner_->visit_limit_ = visits + (visit_limit_ > visits_ ? visit_limit_ - visits_ : 0);
    Operands operands(*inner_, ray_, frames_[frame_number]);
    std::optional<Boundary> boundary;
    const double least = range.least;
    const bool holds = operands.holds(least);
    if (search_ == Search::inside) {
        if (holds) boundary = operands.leave(least, INFINITY);
    } else if (holds && search_ == Search::surface) {
        boundary = operands.leave(least, best_.t);
    } else {
        std::optional<Boundary> out;
        if (holds) out = operands.leave(least, best_.t);
        if (!holds || out) boundary = operands.enter(out ? out->t : least, best_.t);
    }
    visits_ += inner_->visits_ - visits;
    boxes_ += inner_->boxes_ - boxes;
    more_work_ += inner_->more_work_ - more;
    if (!boundary) return false;
    if (search_ == Search::inside) {
        if (!(boundary->t > leaves_)) return false;
        leaves_ = boundary->t;
        boundary->t = best_.t; // to go on
    }
    best_ = boundary->best;
    best_.t = boundary->t;
    keep_way(frame_number);
    way_.insert(way_.end(), boundary->way.begin(), boundary->way.end());
    return true;
}

} // namespace graftal
