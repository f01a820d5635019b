#include "compiler/primitives/texture_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/primitives/triangle_mesh.h"

namespace graftal {

namespace {

using std::numbers::pi;

constexpr double most_along = 1e6;

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

TextureSpace texture_space(const Primitive& primitive, double around, double turns) {
    const TextureWrap& wrap = traits_of(primitive).wrap;
    if (!wrap.around) return {};
    return {around, wrap.along ? std::clamp(std::round(around * turns), 1.0, most_along) : 1};
}

bool has_texture_points(const Primitive& primitive) {
    const auto* const mesh = dynamic_cast<const TriangleMesh*>(primitive.shape().get());
    return mesh && !mesh->data.uv.empty();
}

double turn_about_y(const TextureSpace& space, Vec3 point) {
    return space.around * std::atan2(point.x, point.z) / (2 * pi);
}

TexturePoint texture_coordinates(const Primitive& primitive, const TextureSpace& space, Vec3 point) {
    return traits_of(primitive).texture_point(primitive, space, point);
}

std::array<TexturePoint, 3> texture_coordinates(const Primitive& primitive, const TextureSpace& space,
                                                const std::array<Vec3, 3>& points) {
    const PrimitiveTraits& traits = traits_of(primitive);
    if (traits.texture_triangle) return traits.texture_triangle(primitive, space, points);
    const TextureWrap& wrap = traits.wrap;
    std::array<TexturePoint, 3> uv;
    for (std::size_t i = 0; i < 3; ++i)
        uv[i] = texture_coordinates(primitive, space, points[i]);
    if (wrap.around) {
        unwrap(uv, 0, space.around, points);
        settle_poles(uv, points);
    }
    if (wrap.tube) unwrap(uv, 1, 1, points);
    return uv;
}

} // namespace graftal
