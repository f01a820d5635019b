#include "runtime/plants/outline.h"

#include <algorithm>
#include <cstddef>

namespace graftal {

namespace {

/// Twice the area of the triangle; positive where it turns left.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

} // namespace

void Outline::add(glm::dvec2 point) {
    points_.push_back(point);
    if (points_.size() < next_shrink_) return;
    shrink();
    next_shrink_ = std::max(next_shrink_, 2 * points_.size());
}

/// Leaves the corners of the hull, in order (Andrew 1979: the lower chain, then the upper one).
void Outline::shrink() {
    std::ranges::sort(points_,
                      [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    const auto equal = std::ranges::unique(points_);
    points_.erase(equal.begin(), equal.end());
    if (points_.size() < 3) return;
    std::vector<glm::dvec2> hull;
    const auto chain = [&hull](const auto& points) {
        const std::size_t first = hull.size();
        for (const glm::dvec2 point : points) {
            while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0)
                hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back(); // the other chain begins with it
    };
    chain(points_);
    std::ranges::reverse(points_);
    chain(points_);
    points_ = std::move(hull);
}

double Outline::area() {
    shrink();
    double sum = 0;
    for (std::size_t i = 2; i < points_.size(); ++i)
        sum += turn(points_[0], points_[i - 1], points_[i]);
    return sum / 2;
}

} // namespace graftal
