#pragma once

// Cylinder, cone and frustum: what tapers from radius 1 at y = 0 to another radius at y = 1, capped.

#include "compiler/primitives/passage.h"
#include "compiler/primitives/primitive.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

/// The radius at y = 1. Requires one of the three.
double top_radius(const Primitive& primitive);

// Columns of their rows (primitive.h).
Box tapered_box(const Primitive& primitive);
Ball tapered_ball(const Primitive& primitive);
std::vector<ConvexPart> tapered_convex_parts(const Primitive& primitive);
double tapered_inner_radius(const Primitive& primitive);
Vec3 tapered_fixed_point(const Primitive& primitive);
bool tapered_keeps(const Primitive& primitive, const Affine& map);
double tapered_mesh_error(const Primitive& primitive, int fineness);
TexturePoint tapered_texture_point(const Primitive& primitive, const TextureSpace& space, Vec3 point);
double tapered_area(const Primitive& primitive);
double tapered_volume(const Primitive& primitive);
SurfaceSite tapered_site(const Primitive& primitive, Vec3 choice);
// Columns of those with two caps.
std::vector<HullPiece> tapered_hull(const Primitive& primitive);
TessellatedPrimitive tapered_mesh(const Primitive& primitive, int fineness);

/// A whole row: the columns that differ, and those that all three share.
constexpr PrimitiveTraits tapered_row(PrimitiveTraits own) {
    own.box = tapered_box;
    own.ball = tapered_ball;
    own.convex_parts = tapered_convex_parts;
    own.inner_radius = tapered_inner_radius;
    own.fixed_point = tapered_fixed_point;
    own.keeps = tapered_keeps;
    own.max_fineness = 8;
    own.mesh_error = tapered_mesh_error;
    own.wrap = {.around = true, .along = true};
    own.texture_point = tapered_texture_point;
    own.area = tapered_area;
    own.volume = tapered_volume;
    own.site = tapered_site;
    return own;
}

/// Number of sides of a prism or pyramid of this fineness.
int prism_sides(int fineness);
/// A cap of n corners, spokes of the given radius at height y. It is cut into triangles of three equal arcs
/// and then of halves of arcs: no slivers around one corner.
void add_cap(TessellatedPrimitive& mesh, int n, double radius, double y, bool facing_up);

/// A site of a disc about the y axis.
SurfaceSite disc_site(Vec3 choice, double radius, double y);
/// The height below which the side has the share `u` of its area, however the axis stretches it.
double height_on_side(double u, double top);

/// Zero on the cone x^2 + z^2 = y^2.
inline double cone_form(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.z * b.z - a.y * b.y;
}

/// Within the nappe y >= 0 of the cone x^2 + z^2 <= y^2; if the direction has no y, perhaps within the other.
/// The point is the ray's nearest to the apex.
inline Passage within_cone(const Vec3& point, const Vec3& direction) {
    const double a = cone_form(direction, direction), b = cone_form(point, direction);
    const double c = cone_form(point, point);
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return no_passage;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0 && a == 0) return no_passage; // along a side
    const double one = q / a, other = q == 0 ? 0 : c / q;
    if (a >= 0) return {std::min(one, other), std::max(one, other)};
    return direction.y < 0 ? Passage{no_passage.leave, std::min(one, other)}
                           : Passage{std::max(one, other), no_passage.enter};
}

/// The primitives are parts of one cone with the radius in place of the height, the cylinder a section of
/// it. Inlined into the rows of cylinder and cone, whose `top` is a constant.
inline bool intersect_tapered(double top, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const double taper = 1 - top;
    const Vec3 origin(ray.origin.x, 1 - taper * ray.origin.y, ray.origin.z);
    const Vec3 direction(ray.direction.x, -taper * ray.direction.y, ray.direction.z);
    const double speed2 = glm::dot(direction, direction);
    const bool upright = speed2 < parallel_to_plane * parallel_to_plane;
    const double middle = upright ? 0 : -glm::dot(origin, direction) / speed2;
    const Vec3 point = origin + middle * direction;
    if (!(glm::dot(point, point) < 2.1)) return false; // the rim is the farthest from the apex, sqrt(2)

    const Passage caps = between(0, 1, ray.origin.y, ray.direction.y);
    Passage side;
    if (!upright) {
        side = within_cone(point, direction);
        side = {middle + side.enter, middle + side.leave};
    } else if (cone_form(point, point) > 0) {
        return false;
    }
    PassageEnd end;
    if (!first_end(both(caps, side), range, end)) return false;
    hit = {end.t, {0, 1, 0}};
    if (end.t == end.of(caps)) {
        hit.normal.y = end.outwards(ray.direction.y);
        return true;
    }
    const Vec3 at = point + (end.t - middle) * direction;
    const Vec3 slope(at.x, taper * at.y, at.z);
    const double size2 = glm::dot(slope, slope);
    if (size2 > 1e-300) hit.normal = slope * (1 / std::sqrt(size2)); // the apex itself has none: up, then
    return true;
}

} // namespace graftal
