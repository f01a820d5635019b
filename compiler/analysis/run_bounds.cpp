#include "compiler/analysis/run_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/analysis/smallest_ball.h"

namespace graftal {

namespace {

/// Share of the coordinates, upwards: the rounding of sums of a few numbers.
constexpr double rounding = 4e-15;

/// The radius at the far end.
double far_radius(const RunItem& item) {
    return item.ball ? item.radius : item.shape.top_radius() * item.radius;
}

Vec3 far_end(const RunItem& item) {
    return item.base + item.axis;
}

/// A point of the disc about `centre`, at right angles to the unit vector `y`, that is farthest along
/// `direction`.
Vec3 rim_point(Vec3 centre, double radius, Vec3 y, Vec3 direction) {
    const Vec3 aside = direction - glm::dot(direction, y) * y;
    const double length = glm::length(aside);
    return centre + radius * (length > 0 ? aside / length : across(y));
}

Vec3 support_point_of(const RunItem& item, Vec3 direction) {
    const double length = glm::length(direction);
    const Vec3 ahead = length > 0 ? direction / length : Vec3(0, 1, 0);
    if (item.shape.is_sphere()) return item.base + item.radius * ahead;
    const double axis_length = glm::length(item.axis);
    const Vec3 y = axis_length > 0 ? item.axis / axis_length : Vec3(0, 1, 0);
    const Vec3 near_point = rim_point(item.base, item.radius, y, direction);
    const Vec3 far_point = item.ball ? far_end(item) + item.radius * ahead
                                     : rim_point(far_end(item), far_radius(item), y, direction);
    return glm::dot(near_point, direction) > glm::dot(far_point, direction) ? near_point : far_point;
}

/// The point of an item that is farthest from `centre`.
Vec3 farthest_point_of(const RunItem& item, Vec3 centre) {
    if (item.shape.is_sphere()) return support_point_of(item, item.base - centre);
    const double axis_length = glm::length(item.axis);
    const Vec3 y = axis_length > 0 ? item.axis / axis_length : Vec3(0, 1, 0);
    const Vec3 end = far_end(item), from_end = end - centre;
    const double distance = glm::length(from_end);
    const Vec3 near_point = rim_point(item.base, item.radius, y, item.base - centre);
    const Vec3 far_point = item.ball && distance > 0 ? end + (item.radius / distance) * from_end
                                                     : rim_point(end, far_radius(item), y, from_end);
    return glm::distance(near_point, centre) > glm::distance(far_point, centre) ? near_point : far_point;
}

double support_of(const Box& box, Vec3 direction) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += direction[i] * (direction[i] > 0 ? box.max[i] : box.min[i]);
    return sum;
}

double farthest_of(const Box& box, Vec3 centre) {
    return glm::length(glm::max(glm::abs(box.min - centre), glm::abs(box.max - centre)));
}

} // namespace

Box box_of(const RunItem& item) {
    Vec3 near_reach(item.radius), far_reach(0.0);
    Vec3 end = item.base;
    if (!item.shape.is_sphere()) {
        const double square = glm::dot(item.axis, item.axis);
        const Vec3 y = square > 0 ? item.axis / std::sqrt(square) : Vec3(0, 1, 0);
        for (int i = 0; i < 3; ++i)
            near_reach[i] = item.radius * std::sqrt(std::max(0.0, 1 - y[i] * y[i]));
        end = far_end(item);
        far_reach = item.ball ? Vec3(item.radius) : item.shape.top_radius() * near_reach;
    } else {
        far_reach = near_reach;
    }
    Box box{glm::min(item.base - near_reach, end - far_reach),
            glm::max(item.base + near_reach, end + far_reach)};
    const Vec3 slack =
        rounding * glm::max(glm::abs(box.min), glm::abs(box.max)) + Vec3(rounding * item.radius);
    box.min -= slack;
    box.max += slack;
    return box;
}

RunBounds::RunBounds(std::shared_ptr<const Run> run) : run_(std::move(run)) {
    std::vector<Box>& lowest = levels_.emplace_back((run_->size() + items_a_range - 1) / items_a_range);
    for (std::size_t i = 0; i < run_->size(); ++i)
        lowest[i / items_a_range].include(box_of((*run_)[i]));
    while (levels_.back().size() > 1) {
        const std::vector<Box>& below = levels_.back();
        std::vector<Box> above((below.size() + ranges_a_range - 1) / ranges_a_range);
        for (std::size_t i = 0; i < below.size(); ++i)
            above[i / ranges_a_range].include(below[i]);
        levels_.push_back(std::move(above));
    }
    find_ball();
}

std::size_t RunBounds::range_size(std::size_t level) {
    std::size_t size = items_a_range;
    for (; level > 0; --level)
        size *= ranges_a_range;
    return size;
}

/// Calls `of_item` on the items that may exceed what it returned so far, by the upper bounds of boxes.
template<typename UpperOf, typename OfItem>
void RunBounds::search(const UpperOf& upper_of, const OfItem& of_item) const {
    struct Range {
        double upper;
        std::size_t level, index;
    };
    std::vector<Range> open = {{upper_of(box()), levels_.size() - 1, 0}};
    double best = -std::numeric_limits<double>::infinity();
    while (!open.empty()) {
        const Range range = open.back();
        open.pop_back();
        if (range.upper <= best) continue;
        if (range.level == 0) {
            const std::size_t first = range.index * items_a_range;
            for (std::size_t i = first; i < std::min(first + items_a_range, run_->size()); ++i)
                best = std::max(best, of_item((*run_)[i]));
            continue;
        }
        const std::vector<Box>& below = levels_[range.level - 1];
        const std::size_t first = range.index * ranges_a_range, before = open.size();
        for (std::size_t i = first; i < std::min(first + ranges_a_range, below.size()); ++i)
            open.push_back({upper_of(below[i]), range.level - 1, i});
        // Ranges that reach farthest come first.
        std::sort(open.begin() + static_cast<std::ptrdiff_t>(before), open.end(),
                  [](const Range& a, const Range& b) { return a.upper < b.upper; });
    }
}

Vec3 RunBounds::support_point(Vec3 direction) const {
    Vec3 best_point(0.0);
    double best = -std::numeric_limits<double>::infinity();
    search([&](const Box& box) { return support_of(box, direction); },
           [&](const RunItem& item) {
               const Vec3 point = support_point_of(item, direction);
               const double reach = glm::dot(point, direction);
               if (reach > best) best = reach, best_point = point;
               return best;
           });
    return best_point;
}

Vec3 RunBounds::surface_near(Vec3 point, Vec3 to_eye) const {
    Vec3 seen(0.0);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < run_->size(); ++i) {
        const RunItem& item = (*run_)[i];
        const bool round = item.shape.is_sphere();
        const double square = glm::dot(item.axis, item.axis);
        const double share = round || !(square > 0)
                                 ? 0
                                 : std::clamp(glm::dot(point - item.base, item.axis) / square, 0.0, 1.0);
        const Vec3 inside = item.base + share * item.axis;
        const double distance = glm::distance(inside, point) - item.radius;
        if (!(distance < nearest)) continue;
        nearest = distance;
        const Vec3 out =
            round || !(square > 0) ? to_eye : to_eye - glm::dot(to_eye, item.axis) / square * item.axis;
        const double length = glm::length(out), narrowing = item.ball ? 0 : 1 - item.shape.top_radius();
        seen =
            length > 0 ? inside + item.radius * (round ? 1 : 1 - share * narrowing) / length * out : inside;
    }
    return seen;
}

double RunBounds::farthest_from(Vec3 centre, Vec3& point) const {
    double best = -std::numeric_limits<double>::infinity();
    search([&](const Box& box) { return farthest_of(box, centre); },
           [&](const RunItem& item) {
               const Vec3 candidate = farthest_point_of(item, centre);
               const double distance = glm::distance(candidate, centre);
               if (distance > best) best = distance, point = candidate;
               return best;
           });
    return best;
}

/// The smallest ball about some points; the farthest point from its centre is one more of them, until none
/// lies farther (M. Badoiu and K. Clarkson, "Smaller Core-Sets for Balls", 2003).
void RunBounds::find_ball() {
    constexpr int most_points = 100;
    constexpr double close_enough = 1e-6;
    std::vector<Ball> points;
    Ball about{box().centre(), 0};
    for (int count = 0; count < most_points; ++count) {
        Vec3 point;
        const double radius = farthest_from(about.centre, point) * (1 + 1e-12);
        if (ball_.empty() || radius < ball_.radius) ball_ = {about.centre, radius};
        if (radius <= (1 + close_enough) * about.radius) return;
        points.push_back({point, 0});
        about = smallest_ball(points);
    }
}

} // namespace graftal
