#include "compiler/primitives/shape_parts.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/support/number.h"

namespace graftal {

std::string shape_name(PrimitiveKind kind, std::span<const double> numbers) {
    std::string name(name_of(kind));
    const char* separator = "(";
    for (const double number : numbers) {
        name += separator + shortest(number == 0 ? 0 : number); // -0 and 0 are one number
        separator = ", ";
    }
    return name + ")";
}

Vec3 area_normal(const Triangle& t) {
    return glm::cross(t[1] - t[0], t[2] - t[0]);
}

Vec3 point_of(const Triangle& t, double u, double v) {
    const double root = std::sqrt(u);
    return (1 - root) * t[0] + root * (1 - v) * t[1] + root * v * t[2];
}

Box box_about(std::span<const Vec3> points) {
    Box box;
    for (const Vec3& point : points)
        box.include(point);
    return box;
}

Ball ball_about(std::span<const Vec3> points) {
    Ball ball{box_about(points).centre(), 0};
    for (const Vec3& point : points)
        ball.radius = std::max(ball.radius, glm::distance(ball.centre, point));
    return ball;
}

Vec3 farthest_of(std::span<const Vec3> points, Vec3 direction) {
    return *std::ranges::max_element(points, {},
                                     [&](const Vec3& point) { return glm::dot(point, direction); });
}

} // namespace graftal
