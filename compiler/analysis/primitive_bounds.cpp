#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/primitive_shape.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr double half_sqrt3 = std::numbers::sqrt3 / 2;
constexpr double tube = 0.25; // the torus's minor radius

/// The point of the circle of radius 1 about the y axis that is farthest along `direction`.
Vec3 on_circle(Vec3 direction, double height) {
    const double length = std::hypot(direction.x, direction.z);
    if (!(length > 0)) return {1, height, 0};
    return {direction.x / length, height, direction.z / length};
}

Vec3 farther(Vec3 direction, Vec3 a, Vec3 b) {
    return glm::dot(direction, a) >= glm::dot(direction, b) ? a : b;
}

} // namespace

std::array<Vec3, 3> triangle_corners() {
    return {Vec3(0, 1, 0), Vec3(-half_sqrt3, -0.5, 0), Vec3(half_sqrt3, -0.5, 0)};
}

Vec3 primitive_support_point(PrimitiveKind kind, Vec3 direction) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle: {
        const auto [top, left, right] = triangle_corners();
        return farther(direction, top, farther(direction, left, right));
    }
    case PrimitiveKind::sphere: {
        const double length = glm::length(direction);
        return length > 0 ? direction / length : Vec3(1, 0, 0);
    }
    case PrimitiveKind::cube:
        return {std::copysign(1.0, direction.x), std::copysign(1.0, direction.y),
                std::copysign(1.0, direction.z)};
    case PrimitiveKind::cylinder:
        return on_circle(direction, direction.y > 0 ? 1 : 0);
    case PrimitiveKind::cone:
        return farther(direction, Vec3(0, 1, 0), on_circle(direction, 0));
    case PrimitiveKind::frustum: {
        const Vec3 low = on_circle(direction, 0);
        return farther(direction, Vec3(0, 1, 0) + top_radius(kind) * low, low);
    }
    case PrimitiveKind::torus: {
        const double length = glm::length(direction);
        const Vec3 outward = length > 0 ? direction / length : Vec3(1, 0, 0);
        return on_circle(direction, 0) + tube * outward;
    }
    case PrimitiveKind::plane:
        break;
    }
    GRAFTAL_CHECK(kind != PrimitiveKind::plane, "a plane has no support function");
    return Vec3(0.0);
}

double primitive_support(PrimitiveKind kind, Vec3 direction) {
    return glm::dot(direction, primitive_support_point(kind, direction));
}

ObjectBounds primitive_bounds(PrimitiveKind kind) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return {{{-half_sqrt3, -0.5, 0}, {half_sqrt3, 1, 0}}, {Vec3(0.0), 1}, false};
    case PrimitiveKind::sphere:
        return {{Vec3(-1.0), Vec3(1.0)}, {Vec3(0.0), 1}, false};
    case PrimitiveKind::cube:
        return {{Vec3(-1.0), Vec3(1.0)}, {Vec3(0.0), std::numbers::sqrt3}, false};
    case PrimitiveKind::plane:
        return {{}, {}, true};
    case PrimitiveKind::cylinder:
        return {{{-1, 0, -1}, {1, 1, 1}}, {{0, 0.5, 0}, std::hypot(1.0, 0.5)}, false};
    case PrimitiveKind::cone:
        return {{{-1, 0, -1}, {1, 1, 1}}, {Vec3(0.0), 1}, false};
    case PrimitiveKind::frustum: { // through the rims of both caps
        const double middle = top_radius(kind) * top_radius(kind) / 2;
        return {{{-1, 0, -1}, {1, 1, 1}}, {{0, middle, 0}, std::hypot(1.0, middle)}, false};
    }
    case PrimitiveKind::torus:
        return {{{-1 - tube, -tube, -1 - tube}, {1 + tube, tube, 1 + tube}}, {Vec3(0.0), 1 + tube}, false};
    }
    return {};
}

} // namespace graftal
