#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/primitives/passage.h"
#include "compiler/primitives/shape_parts.h"
#include "compiler/primitives/symmetry_maps.h"

namespace graftal {
namespace {

Box box(const Primitive&) {
    return {Vec3(-1.0), Vec3(1.0)};
}

Ball ball(const Primitive&) {
    return {Vec3(0.0), std::numbers::sqrt3};
}

Vec3 support_point(const Primitive&, Vec3 direction) {
    return {std::copysign(1.0, direction.x), std::copysign(1.0, direction.y),
            std::copysign(1.0, direction.z)};
}

std::vector<ConvexPart> convex_parts(const Primitive&) {
    ConvexPart part{{}, 4};
    for (const double z : {-1.0, 1.0})
        part.corners.insert(part.corners.end(), {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}});
    return {part};
}

double inner_radius(const Primitive&) {
    return 1;
}

/// Orthogonal with columns of 1-norm 1: a signed permutation.
bool keeps(const Primitive&, const Affine& map) {
    return turns_about_origin(map) &&
           std::abs(glm::dot(glm::abs(map.linear[0]), Vec3(1.0)) - 1) < symmetry_tolerance &&
           std::abs(glm::dot(glm::abs(map.linear[1]), Vec3(1.0)) - 1) < symmetry_tolerance;
}

/// The corners of the two faces across an axis by their numbers, whose bits are the signs of x, y and z.
struct FacePair {
    std::uint32_t u, v, w;

    explicit FacePair(std::uint32_t axis) : u(1u << (axis + 1) % 3), v(1u << (axis + 2) % 3), w(1u << axis) {}
};

TessellatedPrimitive mesh(const Primitive&, int) {
    TessellatedPrimitive mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.vertices.emplace_back(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const auto [u, v, w] = FacePair(axis);
        // The diagonal of either face runs from the least corner to the greatest.
        mesh.triangles.insert(mesh.triangles.end(),
                              {{w, w | u, w | u | v}, {w, w | u | v, w | v}, {0, u | v, u}, {0, v, u | v}});
    }
    return mesh;
}

std::vector<FacetCorners> facets(const Primitive&) {
    std::vector<FacetCorners> quads;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const auto [u, v, w] = FacePair(axis);
        quads.push_back({w, w | u, w | u | v, w | v});
        quads.push_back({0, v, u | v, u});
    }
    return quads;
}

/// The picture over the faces before and behind, and through what is between.
TexturePoint texture_point(const Primitive&, const TextureSpace&, Vec3 point) {
    return {0.5 * (point.x + 1), 0.5 * (point.y + 1)};
}

double area(const Primitive&) {
    return 24;
}

double volume(const Primitive&) {
    return 8;
}

SurfaceSite site(const Primitive&, Vec3 u) {
    const int face = std::min(static_cast<int>(6 * u.z), 5);
    const int axis = face / 2;
    Vec3 normal(0.0);
    normal[axis] = face % 2 ? 1 : -1;
    Vec3 p = normal;
    p[(axis + 1) % 3] = 2 * u.x - 1;
    p[(axis + 2) % 3] = 2 * u.y - 1;
    return {p, normal};
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const Vec3 &o = ray.origin, &d = ray.direction;
    const Passage x = between(-1, 1, o.x, d.x), y = between(-1, 1, o.y, d.y), z = between(-1, 1, o.z, d.z);
    PassageEnd end;
    if (!first_end(both(both(x, y), z), range, end)) return false;
    hit = {end.t, Vec3(0.0)};
    if (end.t == end.of(x))
        hit.normal.x = end.outwards(d.x);
    else if (end.t == end.of(y))
        hit.normal.y = end.outwards(d.y);
    else
        hit.normal.z = end.outwards(d.z);
    return true;
}

} // namespace

constinit const PrimitiveTraits cube_traits = flat_row(
    {
        .box = box,
        .ball = ball,
        .support_point = support_point,
        .inner_radius = inner_radius,
        .keeps = keeps,
        .mesh = mesh,
        .solid = true,
        .texture_point = texture_point,
        .area = area,
        .volume = volume,
        .site = site,
        .intersect = intersect,
    },
    {.convex_parts = convex_parts, .facets = facets});

} // namespace graftal
