#include "compiler/detail/texture_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

using std::numbers::pi;

constexpr double most_along = 1e6;

bool is_long(PrimitiveKind kind) {
    const PrimitiveKind family = family_of(kind);
    return family == PrimitiveKind::cylinder || family == PrimitiveKind::cone ||
           family == PrimitiveKind::frustum;
}

bool is_round(PrimitiveKind kind) {
    return is_long(kind) || kind == PrimitiveKind::sphere || kind == PrimitiveKind::torus;
}

/// On the axis u is anything.
bool is_pole(Vec3 point) {
    return std::hypot(point.x, point.z) < 1e-9;
}

/// Moves what lies on the other side of a seam, where the coordinate jumps by `whole`.
void unwrap(std::array<TexturePoint, 3>& uv, std::size_t axis, double whole,
            const std::array<Vec3, 3>& points) {
    double most = -whole;
    for (std::size_t i = 0; i < 3; ++i)
        if (!is_pole(points[i])) most = std::max(most, uv[i][axis]);
    for (TexturePoint& point : uv)
        if (most - point[axis] > 0.5 * whole) point[axis] += whole;
}

/// A pole lies between the others.
void settle_poles(std::array<TexturePoint, 3>& uv, const std::array<Vec3, 3>& points) {
    for (std::size_t i = 0; i < 3; ++i)
        if (is_pole(points[i])) uv[i][0] = 0.5 * (uv[(i + 1) % 3][0] + uv[(i + 2) % 3][0]);
}

} // namespace

double length_in_turns(const Mat3& parent_from_primitive) {
    const double circumference = 2 * pi * glm::length(parent_from_primitive[0]);
    return circumference > 0 ? glm::length(parent_from_primitive[1]) / circumference : 0;
}

TextureSpace texture_space(PrimitiveKind kind, double around, double turns) {
    if (!is_round(kind)) return {};
    return {around, is_long(kind) ? std::clamp(std::round(around * turns), 1.0, most_along) : 1};
}

TexturePoint texture_coordinates(PrimitiveKind kind, const TextureSpace& space, Vec3 point) {
    const double u = space.around * std::atan2(point.x, point.z) / (2 * pi);
    switch (family_of(kind)) {
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return {u, space.along * point.y};
    case PrimitiveKind::sphere:
        return {u, 0.5 + std::asin(std::clamp(point.y / glm::length(point), -1.0, 1.0)) / pi};
    case PrimitiveKind::torus:
        return {u, std::atan2(point.y, std::hypot(point.x, point.z) - 1) / (2 * pi)};
    case PrimitiveKind::triangle:
        return {0.5 + point.x / std::numbers::sqrt3, (point.y + 0.5) / 1.5};
    case PrimitiveKind::cube:
        return {0.5 * (point.x + 1), 0.5 * (point.y + 1)};
    case PrimitiveKind::plane:
        break;
    }
    return {u, 0};
}

std::array<TexturePoint, 3> texture_coordinates(PrimitiveKind kind, const TextureSpace& space,
                                                const std::array<Vec3, 3>& points) {
    std::array<TexturePoint, 3> uv;
    for (std::size_t i = 0; i < 3; ++i)
        uv[i] = texture_coordinates(kind, space, points[i]);
    if (is_round(kind)) {
        unwrap(uv, 0, space.around, points);
        settle_poles(uv, points);
    }
    if (kind == PrimitiveKind::torus) unwrap(uv, 1, 1, points);
    return uv;
}

} // namespace graftal
