#include "compiler/lower/point_maps.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace graftal {

namespace {

/// Shares of the space that the edges of points fill: less than this is none.
constexpr double least_share = 1e-12;

/// The map of the linear part that takes the first point to its image.
Affine through(const Mat3& linear, Vec3 point, Vec3 image) {
    return {linear, image - linear * point};
}

} // namespace

Affine flat_map(Vec3 x, Vec3 y, Vec3 offset) {
    const double largest = std::max({std::abs(x.x), std::abs(x.y), std::abs(y.x), std::abs(y.y)});
    double z = 0;
    if (largest > 0) { // divided first, so that the determinant stays in range
        const double det = (x.x / largest) * (y.y / largest) - (y.x / largest) * (x.y / largest);
        z = largest * std::sqrt(std::abs(det));
    }
    return {Mat3(x, y, Vec3(0, 0, z)), offset};
}

std::optional<Affine> map_by_points(std::span<const Vec3> points, std::span<const Vec3> images) {
    const Vec3 a = points[1] - points[0], to_a = images[1] - images[0];
    const auto turned = [](Vec3 v) { return Vec3(-v.y, v.x, 0); };
    const Vec3 b = points.size() > 2 ? points[2] - points[0] : turned(a);
    const Vec3 to_b = points.size() > 2 ? images[2] - images[0] : turned(to_a);
    if (points.size() < 4) {
        const double area = a.x * b.y - b.x * a.y;
        if (!(std::abs(area) > least_share * glm::length(a) * glm::length(b))) return std::nullopt;
        // Columns of the map by Cramer's rule.
        const Vec3 x = (b.y * to_a - a.y * to_b) / area, y = (a.x * to_b - b.x * to_a) / area;
        return through(flat_map(x, y, {}).linear, points[0], images[0]);
    }
    const Vec3 c = points[3] - points[0];
    const Mat3 edges(a, b, c);
    const double volume = glm::determinant(edges);
    if (!(std::abs(volume) > least_share * glm::length(a) * glm::length(b) * glm::length(c)))
        return std::nullopt;
    return through(Mat3(to_a, to_b, images[3] - images[0]) * glm::inverse(edges), points[0], images[0]);
}

} // namespace graftal
