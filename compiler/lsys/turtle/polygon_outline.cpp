#include "compiler/lsys/turtle/polygon_outline.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "compiler/lsys/turtle/thin_ring.h"
#include "compiler/lsys/turtle/triangulate.h"

namespace graftal {

namespace {

using Vec2 = glm::dvec2;

constexpr double per_unit = 1e6;    ///< steps of coordinates in an outline of size 1
constexpr double most_depth = 1e-4; ///< of a corner, from the plane of a polygon of size 1
constexpr double least_area = 1e-9; ///< twice it, of the triangle at a corner of such a polygon
constexpr double least_sine = 1e-6; ///< of the angle between two directions that are told apart
constexpr double most_plain = 1e50; ///< squares of areas are numbers up to here

double rounded(double x) {
    return std::round(x * per_unit) / per_unit + 0.0; // no negative zeros
}

/// The outline's axes in the plane with this normal.
Mat3 axes_in_plane(const Mat3& axes, Vec3 normal) {
    const auto in_plane = [&](Vec3 way) { return way - glm::dot(way, normal) * normal; };
    Vec3 y = in_plane(axes[1]);
    if (!(glm::length(y) > least_sine)) y = in_plane(axes[2]);
    y = glm::normalize(y);
    Vec3 x = glm::cross(y, normal);
    const double to_the_right = glm::dot(x, axes[0]);
    const double side = std::abs(to_the_right) > least_sine ? to_the_right : glm::dot(x, axes[2]);
    if (side < 0) x = -x;
    return {x, y, glm::cross(x, y)};
}

bool is_straight(Vec2 a, Vec2 b, Vec2 c) {
    return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) <= least_area;
}

/// Leaves out corners between their neighbours, spikes and repeated ones.
void drop_straight_corners(std::vector<Vec2>& corners) {
    thin_ring(corners, [&](std::size_t at) {
        const Vec2 before = corners[(at + corners.size() - 1) % corners.size()];
        return is_straight(before, corners[at], corners[(at + 1) % corners.size()]);
    });
}

} // namespace

std::optional<PolygonOutline> outline_of(std::span<const Vec3> corners, const Mat3& axes) {
    if (corners.size() < 3) return std::nullopt;
    double size = 0;
    for (const Vec3& corner : corners)
        size = std::max(size, largest_entry(corner - corners[0]));
    if (!(size > 1 / most_plain && size < most_plain)) return std::nullopt;
    std::vector<Vec3> of_size_1;
    for (const Vec3& corner : corners)
        of_size_1.push_back((corner - corners[0]) / size);
    const Vec3 normal = newell_normal(of_size_1);
    if (!(glm::length(normal) > least_area)) return std::nullopt;
    const Mat3 plane = axes_in_plane(axes, glm::normalize(normal));

    std::vector<Vec2> flat;
    for (const Vec3& corner : of_size_1) {
        if (std::abs(glm::dot(corner, plane[2])) > most_depth) return std::nullopt;
        flat.emplace_back(glm::dot(corner, plane[0]), glm::dot(corner, plane[1]));
    }
    drop_straight_corners(flat);
    if (flat.size() < 3 || flat.size() > most_outline_corners) return std::nullopt;
    Vec2 low = flat[0], high = flat[0];
    for (const Vec2& corner : flat) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const double side = std::max(high.x - low.x, high.y - low.y);
    std::vector<Vec2> outline;
    for (const Vec2& corner : flat) {
        const Vec2 at = (corner - flat[0]) / side;
        const Vec2 number(rounded(at.x), rounded(at.y));
        if (outline.empty() || outline.back() != number) outline.push_back(number);
    }
    while (outline.size() > 1 && outline.back() == outline.front())
        outline.pop_back();
    // A `polygon` begins another ring where its first corner comes again.
    if (outline.size() < 3 || std::ranges::count(outline, outline.front()) > 1) return std::nullopt;
    const Vec3 first = flat[0].x * plane[0] + flat[0].y * plane[1];
    PolygonOutline result{{}, {size * side * plane, corners[0] + size * first}};
    for (const Vec2& corner : outline)
        result.numbers.insert(result.numbers.end(), {corner.x, corner.y});
    return result;
}

} // namespace graftal
