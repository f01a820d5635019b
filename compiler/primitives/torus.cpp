#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/primitives/primitive.h"
#include "compiler/primitives/round_mesh.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/primitives/texture_space.h"

namespace graftal {
namespace {

using std::numbers::pi;

constexpr double ring_radius = 1, tube_radius = 0.25;
constexpr double bound = ring_radius + tube_radius;

Box box(const Primitive&) {
    return {{-bound, -tube_radius, -bound}, {bound, tube_radius, bound}};
}

Ball ball(const Primitive&) {
    return {Vec3(0.0), bound};
}

Vec3 support_point(const Primitive&, Vec3 direction) {
    const double length = glm::length(direction);
    const Vec3 outward = length > 0 ? direction / length : Vec3(1, 0, 0);
    return farthest_on_circle(direction, 0) + tube_radius * outward;
}

std::vector<HullPiece> hull(const Primitive&) {
    return {{HullPiece::Kind::disc, Affine(), tube_radius}};
}

double inner_radius(const Primitive&) {
    return 1;
}

bool keeps(const Primitive&, const Affine& map) {
    return turns_about_origin(map) && keeps_y_axis(map.linear);
}

int ring_segments(int fineness) {
    return 6 << fineness;
}

int tube_segments(int fineness) {
    return 3 << fineness;
}

/// A corner of the tube's polygon at fraction j/k of its turn, relative to the tube's centre: (outward, up).
std::pair<double, double> tube_corner(int j, int k) {
    const double angle = 2 * pi * (j % k) / k;
    return {std::cos(angle), std::sin(angle)};
}

TessellatedPrimitive mesh(const Primitive&, int fineness) {
    TessellatedPrimitive mesh;
    const int n = ring_segments(fineness), k = tube_segments(fineness);
    const double ring = balanced_radius(n), tube = tube_radius * balanced_radius(k);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < k; ++j) {
            const auto [out, up] = tube_corner(j, k);
            const Vec3 normal = out * spoke(i, n) + Vec3(0, up, 0);
            add_vertex(mesh, ring * spoke(i, n) + tube * normal, normal);
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < k; ++j) {
            const auto at = [&](int a, int b) { return static_cast<std::uint32_t>((a % n) * k + b % k); };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

/// Each meridian section of the mesh is the tube's polygon, stretched away from the axis by a factor between
/// cos(pi/n) and 1. How far it strays from the tube's circle is largest at a corner or, inwards, on a side.
double mesh_error(const Primitive&, int fineness) {
    const int n = ring_segments(fineness), k = tube_segments(fineness);
    const double ring = balanced_radius(n), tube = tube_radius * balanced_radius(k);
    constexpr int samples = 64;
    double worst = 0;
    for (int sample = 0; sample <= samples; ++sample) {
        const double stretch = 1 - (1 - std::cos(pi / n)) * sample / samples;
        const auto corner = [&](int j) {
            const auto [out, up] = tube_corner(j, k);
            return Vec3(stretch * (ring + tube * out) - 1, tube * up, 0);
        };
        for (int j = 0; j < k; ++j) {
            const Vec3 a = corner(j), side = corner(j + 1) - a;
            const double t = std::clamp(-glm::dot(a, side) / glm::dot(side, side), 0.0, 1.0);
            worst = std::max({worst, glm::length(a) - tube_radius, tube_radius - glm::length(a + t * side)});
        }
    }
    return worst;
}

/// Pieces of a coarse mesh's ring.
std::vector<ConvexPart> convex_parts(const Primitive& torus) {
    constexpr std::size_t count = 12;
    const std::vector<Vec3> ring = mesh(torus, 1).vertices;
    const std::size_t around = ring.size() / count;
    std::vector<ConvexPart> parts(count);
    for (std::size_t part = 0; part < count; ++part)
        for (std::size_t i = 0; i < 2 * around; ++i)
            parts[part].corners.push_back(ring[(part * around + i) % ring.size()]);
    return parts;
}

/// u round the y axis, v round the tube.
TexturePoint texture_point(const Primitive&, const TextureSpace& space, Vec3 point) {
    return {turn_about_y(space, point), std::atan2(point.y, std::hypot(point.x, point.z) - 1) / (2 * pi)};
}

double area(const Primitive&) {
    return 4 * pi * pi * tube_radius;
}

double volume(const Primitive&) {
    return 2 * pi * pi * tube_radius * tube_radius;
}

/// Round the tube the area grows with the distance from the axis: a part of the points moves outwards.
SurfaceSite site(const Primitive&, Vec3 u) {
    double tube = 2 * pi * u.x;
    if (u.z * 2 > 1 + tube_radius * std::cos(tube)) tube = pi - tube;
    const Vec3 out = circle_point(u.y);
    const Vec3 normal = std::cos(tube) * out + Vec3(0, std::sin(tube), 0);
    return {out + tube_radius * normal, normal};
}

// A torus lies where (|x|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + z^2). With s the distance along the ray from its
// point nearest to the centre, this is a quartic without a cubic term. Its coefficients are of the order of
// 1, however far away the ray begins. Closed forms of its roots lose digits, or roots, in just the pictures
// in which tori are seen from a symmetric side. So the roots are isolated instead. The quartic is monotonous
// between its extrema: a bracket with a change of sign holds one root, which Newton's method cannot leave.
//
// The extrema need no great care: an error of e in one changes the quartic there by e^2 only, so that half
// of the digits do.

/// The rounding error of the quartic at a root. The quartic's value is about twice a point's distance from
/// the surface.
constexpr double noise = 4e-16;

/// s^4 + a s^2 + b s + c.
struct Quartic {
    double a, b, c;

    double operator()(double s) const {
        const double square = s * s;
        return (square + a) * square + (b * s + c);
    }
    double slope(double s) const { return (4 * s * s + 2 * a) * s + b; }
    double bend(double s) const { return 12 * s * s + 2 * a; }
};

/// The largest root of s^3 + a s + b, where b <= 0: the only one that is not negative.
double largest_root(double a, double b) {
    // If there are three roots, the largest is at most this; else take a bound on the only one.
    double s = 2 * std::sqrt(std::max(-a, 0.0) / 3);
    if (27 * b * b > -4 * a * a * a) s = std::sqrt(std::max(-a, 0.0)) + std::cbrt(-b);
    // To the right of the root the cubic is convex: Newton's method comes down to it and never passes it.
    for (int step = 0; step < 64; ++step) {
        const double value = (s * s + a) * s + b, slope = 3 * s * s + a;
        if (!(value > 0) || !(slope > 0)) break;
        const double change = value / slope;
        s -= change;
        if (change < 1e-7) break;
    }
    return s;
}

/// Where a quartic has its minima and, between two of them, its maximum.
struct Extrema {
    std::array<double, 3> at;
    int count; ///< 1 or 3; the minima are the first and the last
};

Extrema extrema(const Quartic& quartic) {
    // Mirrored if need be, the largest of the roots of the derivative is the largest in size too: dividing by
    // it is stable.
    const double mirror = quartic.b > 0 ? -1 : 1;
    const double a = quartic.a / 2;
    const double largest = largest_root(a, mirror * quartic.b / 4);
    const double discriminant = -3 * largest * largest - 4 * a;
    if (!(discriminant > 0)) return {{mirror * largest}, 1};
    const double least = -(largest + std::sqrt(discriminant)) / 2, middle = -least - largest;
    if (mirror < 0) return {{-largest, -middle, -least}, 3};
    return {{least, middle, largest}, 3};
}

/// The root between two points with values of different signs, the first of which is `below` zero or not.
/// `minimum` is that one of them at which the quartic has a minimum.
double root_between(const Quartic& quartic, double least, double most, bool below, double minimum) {
    // A parabola through the minimum starts near the root, and the nearer the more the ray grazes.
    const double reach = std::sqrt(-2 * quartic(minimum) / std::max(quartic.bend(minimum), 1e-3));
    double s = minimum == least ? least + reach : most - reach;
    if (!(s > least && s < most)) s = (least + most) / 2;
    for (int step = 0; step < 100; ++step) {
        const double value = quartic(s);
        if (std::abs(value) < noise) break;
        ((value < 0) == below ? least : most) = s;
        double next = s - value / quartic.slope(s);
        if (!(next >= least && next <= most)) next = (least + most) / 2;
        if (std::abs(next - s) < noise) return next;
        s = next;
    }
    return s;
}

Vec3 normal_at(const Vec3& point) {
    const double out = std::sqrt(point.x * point.x + point.z * point.z);
    return glm::normalize(point - Vec3(point.x, 0, point.z) * (ring_radius / out));
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const double speed = glm::length(ray.direction);
    const Vec3 along = ray.direction / speed;
    double middle = -glm::dot(ray.origin, along) / speed;
    Vec3 point = ray(middle);
    // Once more: the quartic has no cubic term only as far as the point is the nearest.
    const double rest = -glm::dot(point, along);
    middle += rest / speed;
    point += rest * along;
    const double away = glm::dot(point, point);
    if (!(away < bound * bound)) return false;
    // The ends lie past the surface on both sides, so that rounding cannot put one inside.
    const double half = std::sqrt(1.1 * bound * bound - away);
    if (std::abs(point.y) - std::abs(along.y) * half > tube_radius) return false;
    constexpr std::uint64_t steps_of_a_quartic = 6; // through a mesh, in that time
    hit.steps = steps_of_a_quartic;

    const double k = away + ring_radius * ring_radius - tube_radius * tube_radius;
    const double four = 4 * ring_radius * ring_radius;
    const Quartic quartic{2 * k - four * (along.x * along.x + along.z * along.z),
                          -2 * four * (point.x * along.x + point.z * along.z),
                          k * k - four * (point.x * point.x + point.z * point.z)};
    const Extrema turns = extrema(quartic);
    double least = -half;
    bool below = false;
    for (int part = 0; part <= turns.count; ++part) {
        const double most = part < turns.count ? std::clamp(turns.at[part], least, half) : half;
        const bool most_below = part < turns.count && quartic(most) < 0;
        if (below != most_below && middle + most / speed > range.least) {
            const double s = root_between(quartic, least, most, below, below ? least : most);
            const double t = middle + s / speed;
            if (!(t < range.most)) return false;
            if (t > range.least) {
                hit = {t, normal_at(point + s * along), steps_of_a_quartic};
                return true;
            }
        }
        least = most;
        below = most_below;
    }
    return false;
}

} // namespace

constinit const PrimitiveTraits torus_traits = {
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
    .wrap = {.around = true, .tube = true},
    .texture_point = texture_point,
    .area = area,
    .volume = volume,
    .site = site,
    .intersect = intersect,
};

} // namespace graftal
