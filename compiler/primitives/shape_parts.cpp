#include "compiler/primitives/shape_parts.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/support/number.h"

namespace graftal {

namespace {

TessellatedPrimitive exact_mesh(const Primitive& primitive) {
    return traits_of(primitive).mesh(primitive, 0);
}

} // namespace

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

std::size_t AreaSampler::piece(double share) const {
    const auto found = std::upper_bound(sums_.begin(), sums_.end() - 1, share * whole());
    return static_cast<std::size_t>(found - sums_.begin());
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

std::vector<HullPiece> hull_of_mesh(const Primitive& primitive) {
    const TessellatedPrimitive mesh = exact_mesh(primitive);
    std::vector<HullPiece> pieces;
    for (const Vec3& corner : mesh.vertices)
        pieces.push_back({HullPiece::Kind::point, Affine::translate(corner)});
    return pieces;
}

std::vector<ConvexPart> triangles_of_mesh(const Primitive& primitive) {
    const TessellatedPrimitive mesh = exact_mesh(primitive);
    std::vector<ConvexPart> parts;
    for (const auto& [a, b, c] : mesh.triangles)
        parts.push_back({{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, 0});
    return parts;
}

std::vector<FacetCorners> facets_of_mesh(const Primitive& primitive) {
    const TessellatedPrimitive mesh = exact_mesh(primitive);
    std::vector<FacetCorners> facets;
    for (const auto& [a, b, c] : mesh.triangles)
        facets.push_back({a, b, c, no_facet_corner});
    return facets;
}

Vec3 centre_of_box(const Primitive& primitive) {
    return traits_of(primitive).box(primitive).centre();
}

double exact_mesh_error(const Primitive&, int) {
    return 0;
}

} // namespace graftal
