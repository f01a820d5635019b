#include "compiler/scene/extremes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr int direction_count = 1000;
constexpr int circle_corners = 72;

/// Points on the sphere by the golden angle.
std::vector<Vec3> spread_directions() {
    std::vector<Vec3> directions;
    for (int i = 0; i < direction_count; ++i) {
        const double y = 1 - (2 * i + 1.0) / direction_count;
        const double radius = std::sqrt(1 - y * y);
        const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
        directions.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
    }
    return directions;
}

} // namespace

Extremes::Extremes() : directions_(spread_directions()), farthest_(directions_.size()) {}

void Extremes::include(const std::vector<Vec3>& points) {
    if (points.empty()) return;
    for (std::size_t i = 0; i < directions_.size(); ++i) {
        const Vec3 direction = directions_[i];
        Vec3 best = empty_ ? points.front() : farthest_[i];
        double most = glm::dot(best, direction);
        for (const Vec3& point : points) {
            const double reach = glm::dot(point, direction);
            if (reach <= most) continue;
            most = reach;
            best = point;
        }
        farthest_[i] = best;
    }
    empty_ = false;
}

std::vector<Vec3> Extremes::points() const {
    if (empty_) return {};
    std::vector<Vec3> points = farthest_;
    const auto before = [](const Vec3& a, const Vec3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    std::sort(points.begin(), points.end(), before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

std::vector<Vec3> revolved(const std::vector<Vec3>& points, Vec3 axis) {
    std::vector<Vec3> corners;
    const double step = 2 * std::numbers::pi / circle_corners;
    for (const Vec3& point : points) {
        // The polygon stands around the circle.
        const double radius = std::hypot(point.x - axis.x, point.z - axis.z) / std::cos(step / 2);
        for (int i = 0; i < circle_corners; ++i)
            corners.emplace_back(axis.x + radius * std::sin(i * step), point.y,
                                 axis.z + radius * std::cos(i * step));
    }
    return corners;
}

} // namespace graftal
