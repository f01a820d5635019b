#include "runtime/plants/outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>

namespace graftal {

namespace {

/// Twice the area of the triangle; positive where it turns left.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

constexpr int ellipse_corners = 64;

} // namespace

void Outline::add(glm::dvec2 point) {
    points_.push_back(point);
    if (points_.size() < next_shrink_) return;
    shrink();
    next_shrink_ = std::max(next_shrink_, 2 * points_.size());
}

void Outline::add_ellipse(glm::dvec2 centre, glm::dvec2 a, glm::dvec2 b) {
    if (a == glm::dvec2(0) && b == glm::dvec2(0)) return add(centre);
    const glm::dvec2 frame[] = {centre + a + b, centre + a - b, centre - a + b, centre - a - b};
    if (std::ranges::all_of(frame, [&](glm::dvec2 corner) { return surrounds(corner); })) return;
    constexpr double step = 2 * std::numbers::pi / ellipse_corners;
    const double scale = std::sqrt(step / std::sin(step)); // a regular polygon then has the circle's area
    for (int i = 0; i < ellipse_corners; ++i)
        add(centre + scale * (std::cos(i * step) * a + std::sin(i * step) * b));
}

/// Whether the point lies in the last hull. O(log n): a search for the two corners that it lies between, seen
/// from the first one.
bool Outline::surrounds(glm::dvec2 point) const {
    if (hull_size_ < 3) return false;
    const auto first = points_.begin() + 1, last = points_.begin() + static_cast<std::ptrdiff_t>(hull_size_);
    const auto behind = std::partition_point(
        first, last, [&](glm::dvec2 corner) { return turn(points_[0], corner, point) >= 0; });
    return behind != first && behind != last && turn(*std::prev(behind), *behind, point) >= 0;
}

/// Leaves the corners of the hull, in order (Andrew 1979: the lower chain, then the upper one).
void Outline::shrink() {
    std::ranges::sort(points_,
                      [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    const auto equal = std::ranges::unique(points_);
    points_.erase(equal.begin(), equal.end());
    hull_size_ = 0;
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
    hull_size_ = points_.size();
}

double Outline::area() {
    shrink();
    double sum = 0;
    for (std::size_t i = 2; i < points_.size(); ++i)
        sum += turn(points_[0], points_[i - 1], points_[i]);
    return sum / 2;
}

} // namespace graftal
