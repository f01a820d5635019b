#include "compiler/analysis/outer.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace graftal {

double Outer::above(Vec3 direction) const {
    const double of_ellipsoid = glm::dot(direction, centre) + glm::length(reach * direction);
    double of_box = 0;
    for (int i = 0; i < 3; ++i)
        of_box += direction[i] * (direction[i] > 0 ? box.max[i] : box.min[i]);
    return std::min(of_ellipsoid, of_box);
}

Vec3 Outer::farthest_point(Vec3 direction) const {
    int best = 0;
    double value = glm::dot(direction, points[0]);
    for (int i = 1; i < point_count; ++i) {
        const double other = glm::dot(direction, points[static_cast<std::size_t>(i)]);
        if (other <= value) continue;
        value = other;
        best = i;
    }
    return points[static_cast<std::size_t>(best)];
}

void Outer::set_ball(const Ball& ball) {
    centre = ball.centre;
    reach = Mat3(ball.radius);
}

Ball Outer::ball() const {
    return {centre, norm(reach)};
}

double within_range(double value) {
    if (std::isnan(value)) return largest_length;
    return std::clamp(value, -largest_length, largest_length);
}

Ball circumball(const Box& box) {
    if (box.empty()) return {};
    const Vec3 half = 0.5 * box.max - 0.5 * box.min;
    return {0.5 * box.max + 0.5 * box.min, within_range(std::hypot(half.x, half.y, half.z))};
}

} // namespace graftal
