#include "runtime/trace/intersect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "runtime/trace/intersect_torus.h"

// A convex solid is met as an intersection of simpler ones: the part of the ray within a quadric is cut to
// the part between two planes. Met each for itself, a side and its cap would leave a crack where both just
// miss.
//
// Quadrics are solved from the ray's point nearest to their centre (the sphere's), axis (the cylinder's) or
// apex (the cone's), not from its origin. This is the geometric form of the discriminant, which keeps its
// digits however far away the origin is, and at the apex: Haines, Guenther and Akenine-Moeller, "Precision
// improvements for ray/sphere intersection", Ray Tracing Gems, 2019, chapter 7.

namespace graftal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A ray that approaches a plane by less for each unit of its way counts as parallel to it.
constexpr double parallel = 1e-20;
/// A ray parallel to a plane may lie this far outside: where two solids touch it belongs to both, not to
/// none.
constexpr double rounding = 1e-14;

/// The part of a ray within a convex solid, its ends included; empty if it enters after it leaves.
struct Passage {
    double enter = -infinity;
    double leave = infinity;
};
constexpr Passage nowhere{infinity, -infinity};

inline Passage both(const Passage& a, const Passage& b) {
    return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
}

inline Passage between(double least, double most, double origin, double direction) {
    if (std::abs(direction) < parallel)
        return origin >= least - rounding && origin <= most + rounding ? Passage{} : nowhere;
    const double inverse = 1 / direction;
    const double a = (least - origin) * inverse, b = (most - origin) * inverse;
    return {std::min(a, b), std::max(a, b)};
}

/// An end of a passage: where the ray enters the solid or, seen from inside, leaves it.
struct End {
    double t;
    bool leaving;

    double of(const Passage& passage) const { return leaving ? passage.leave : passage.enter; }
    /// The direction, of a coordinate, that leads outwards where the ray crosses a plane.
    double outwards(double direction) const { return std::copysign(1.0, leaving ? direction : -direction); }
};

inline bool holds(const RayRange& range, double t) {
    return t > range.least && t < range.most;
}

inline bool first_end(const Passage& passage, const RayRange& range, End& end) {
    if (!(passage.enter <= passage.leave)) return false;
    end.leaving = !(passage.enter > range.least);
    end.t = end.of(passage);
    return holds(range, end.t);
}

bool meet_plane(const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const double t = -ray.origin.y / ray.direction.y; // of a parallel ray not finite, which no range holds
    if (!holds(range, t)) return false;
    hit = {t, {0, 1, 0}};
    return true;
}

bool meet_triangle(const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    constexpr double root3 = 1.7320508075688772;
    const double t = -ray.origin.z / ray.direction.z; // as above
    if (!holds(range, t)) return false;
    const double x = ray.origin.x + t * ray.direction.x, y = ray.origin.y + t * ray.direction.y;
    if (!(y >= -0.5 - rounding && root3 * std::abs(x) + y <= 1 + rounding)) return false;
    hit = {t, {0, 0, 1}};
    return true;
}

bool meet_sphere(const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const double speed2 = glm::dot(ray.direction, ray.direction);
    const double middle = -glm::dot(ray.origin, ray.direction) / speed2;
    const Vec3 point = ray(middle);
    const double left = 1 - glm::dot(point, point);
    if (!(left >= 0)) return false;
    const double half = std::sqrt(left / speed2);
    End end;
    if (!first_end({middle - half, middle + half}, range, end)) return false;
    hit = {end.t, glm::normalize(point + (end.leaving ? half : -half) * ray.direction)};
    return true;
}

bool meet_cube(const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const Vec3 &o = ray.origin, &d = ray.direction;
    const Passage x = between(-1, 1, o.x, d.x), y = between(-1, 1, o.y, d.y), z = between(-1, 1, o.z, d.z);
    End end;
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

/// Zero on the cone x^2 + z^2 = y^2.
inline double cone_form(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.z * b.z - a.y * b.y;
}

/// Within the nappe y >= 0 of the cone x^2 + z^2 <= y^2; if the direction has no y, perhaps within the other.
/// The point is the ray's nearest to the apex.
Passage within_cone(const Vec3& point, const Vec3& direction) {
    const double a = cone_form(direction, direction), b = cone_form(point, direction);
    const double c = cone_form(point, point);
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return nowhere;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0 && a == 0) return nowhere; // along a side
    const double one = q / a, other = q == 0 ? 0 : c / q;
    if (a >= 0) return {std::min(one, other), std::max(one, other)};
    return direction.y < 0 ? Passage{-infinity, std::min(one, other)}
                           : Passage{std::max(one, other), infinity};
}

/// Cylinder, cone and what lies between them. With the radius in place of the height they are all parts of
/// one cone, the cylinder a section of it.
bool meet_tapered(double top, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const double taper = 1 - top;
    const Vec3 origin(ray.origin.x, 1 - taper * ray.origin.y, ray.origin.z);
    const Vec3 direction(ray.direction.x, -taper * ray.direction.y, ray.direction.z);
    const double speed2 = glm::dot(direction, direction);
    const bool upright = speed2 < parallel * parallel;
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
    End end;
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

/// False for what is not finite, and for what is so large or small that squares and roots of it mean nothing.
bool is_sane(const Ray& ray) {
    constexpr double most = 1e12;
    const double far2 = glm::dot(ray.origin, ray.origin), speed2 = glm::dot(ray.direction, ray.direction);
    return far2 <= most * most && speed2 <= most * most && speed2 >= 1 / (most * most);
}

} // namespace

bool intersect(PrimitiveKind kind, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    if (!is_sane(ray)) return false;
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return meet_triangle(ray, range, hit);
    case PrimitiveKind::sphere:
        return meet_sphere(ray, range, hit);
    case PrimitiveKind::cube:
        return meet_cube(ray, range, hit);
    case PrimitiveKind::plane:
        return meet_plane(ray, range, hit);
    case PrimitiveKind::cylinder:
        return meet_tapered(1, ray, range, hit);
    case PrimitiveKind::cone:
        return meet_tapered(0, ray, range, hit);
    case PrimitiveKind::torus:
        return intersect_torus(ray, range, hit);
    case PrimitiveKind::frustum:
        return meet_tapered(top_radius(kind), ray, range, hit);
    }
    return false;
}

} // namespace graftal
