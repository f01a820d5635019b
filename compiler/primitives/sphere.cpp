#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/primitives/passage.h"
#include "compiler/primitives/primitive.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/primitives/texture_space.h"

namespace graftal {
namespace {

using std::numbers::pi;

Box box(const Primitive&) {
    return {Vec3(-1.0), Vec3(1.0)};
}

Ball ball(const Primitive&) {
    return {Vec3(0.0), 1};
}

Vec3 support_point(const Primitive&, Vec3 direction) {
    const double length = glm::length(direction);
    return length > 0 ? direction / length : Vec3(1, 0, 0);
}

std::vector<HullPiece> hull(const Primitive&) {
    return {{HullPiece::Kind::point, Affine(), 1}};
}

double inner_radius(const Primitive&) {
    return 1;
}

bool keeps(const Primitive&, const Affine& map) {
    return turns_about_origin(map);
}

/// The sphere that an octahedron becomes when its edges are halved again and again, on the unit sphere.
TessellatedPrimitive subdivided_octahedron(int fineness) {
    TessellatedPrimitive mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < fineness; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, added] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (added) mesh.vertices.push_back(glm::normalize(mesh.vertices[a] + mesh.vertices[b]));
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        finer.reserve(4 * mesh.triangles.size());
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

/// The least distance of a flat side of a mesh inscribed in the unit sphere from its centre.
double inner_radius_of(const TessellatedPrimitive& mesh) {
    double least = 1;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 corner = mesh.vertices[a];
        const Vec3 normal = glm::cross(mesh.vertices[b] - corner, mesh.vertices[c] - corner);
        least = std::min(least, glm::dot(normal, corner) / glm::length(normal));
    }
    return least;
}

double surface_of(const TessellatedPrimitive& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += 0.5 * glm::length(glm::cross(mesh.vertices[b] - mesh.vertices[a],
                                            mesh.vertices[c] - mesh.vertices[a]));
    return sum;
}

/// The radius of the mesh's corners that makes its shadows as large as the sphere's, over all directions on
/// average. The mean shadow of a convex body is a quarter of its surface (Cauchy).
double corner_radius(const TessellatedPrimitive& inscribed) {
    return std::sqrt(4 * pi / surface_of(inscribed));
}

TessellatedPrimitive mesh(const Primitive&, int fineness) {
    TessellatedPrimitive mesh = subdivided_octahedron(fineness);
    const double radius = corner_radius(mesh);
    mesh.normals = mesh.vertices;
    for (Vec3& vertex : mesh.vertices)
        vertex *= radius;
    return mesh;
}

/// The parts for callers that do not know that a sphere's shadow is an ellipse.
std::vector<ConvexPart> convex_parts(const Primitive& sphere) {
    return {{mesh(sphere, 1).vertices, 0}};
}

double mesh_error(const Primitive&, int fineness) {
    const TessellatedPrimitive inscribed = subdivided_octahedron(fineness);
    const double radius = corner_radius(inscribed);
    return std::max(radius - 1, 1 - radius * inner_radius_of(inscribed));
}

/// u round the y axis, v by latitude.
TexturePoint texture_point(const Primitive&, const TextureSpace& space, Vec3 point) {
    return {turn_about_y(space, point),
            0.5 + std::asin(std::clamp(point.y / glm::length(point), -1.0, 1.0)) / pi};
}

double area(const Primitive&) {
    return 4 * pi;
}

double volume(const Primitive&) {
    return 4 * pi / 3;
}

SurfaceSite site(const Primitive&, Vec3 u) {
    const double y = 2 * u.x - 1;
    Vec3 p = std::sqrt(std::max(0.0, 1 - y * y)) * circle_point(u.y);
    p.y = y;
    return {p, p};
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const double speed2 = glm::dot(ray.direction, ray.direction);
    const double middle = -glm::dot(ray.origin, ray.direction) / speed2;
    const Vec3 point = ray(middle);
    const double left = 1 - glm::dot(point, point);
    if (!(left >= 0)) return false;
    const double half = std::sqrt(left / speed2);
    PassageEnd end;
    if (!first_end({middle - half, middle + half}, range, end)) return false;
    hit = {end.t, glm::normalize(point + (end.leaving ? half : -half) * ray.direction)};
    return true;
}

} // namespace

constinit const PrimitiveTraits sphere_traits = {
    .box = box,
    .ball = ball,
    .support_point = support_point,
    .hull = hull,
    .convex_parts = convex_parts,
    .inner_radius = inner_radius,
    .fixed_point = origin_of,
    .keeps = keeps,
    .max_fineness = 6,
    .mesh = mesh,
    .mesh_error = mesh_error,
    .wrap = {.around = true},
    .texture_point = texture_point,
    .area = area,
    .volume = volume,
    .site = site,
    .intersect = intersect,
};

} // namespace graftal
