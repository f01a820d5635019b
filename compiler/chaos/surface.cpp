#include "compiler/chaos/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double torus_tube = 0.25;

/// A point of a canonical surface, and the unit normal there.
struct Site {
    Vec3 point;
    Vec3 normal;
};

/// Three numbers of [0, 1) that choose a site; evenly spread numbers give evenly spread sites.
using Choice = Vec3;

Vec3 on_circle(double turn) {
    return {std::cos(2 * pi * turn), 0, std::sin(2 * pi * turn)};
}

Site on_triangle(Choice u) {
    const auto corners = triangle_corners();
    const double root = std::sqrt(u.x);
    return {(1 - root) * corners[0] + root * (1 - u.y) * corners[1] + root * u.y * corners[2], {0, 0, 1}};
}

Site on_sphere(Choice u) {
    const double y = 2 * u.x - 1;
    Vec3 p = std::sqrt(std::max(0.0, 1 - y * y)) * on_circle(u.y);
    p.y = y;
    return {p, p};
}

Site on_cube(Choice u) {
    const int face = std::min(static_cast<int>(6 * u.z), 5);
    const int axis = face / 2;
    Vec3 normal(0.0);
    normal[axis] = face % 2 ? 1 : -1;
    Vec3 p = normal;
    p[(axis + 1) % 3] = 2 * u.x - 1;
    p[(axis + 2) % 3] = 2 * u.y - 1;
    return {p, normal};
}

Site on_disc(Choice u, double radius, double y) {
    Vec3 p = radius * std::sqrt(u.x) * on_circle(u.y);
    p.y = y;
    return {p, {0, y > 0 ? 1 : -1, 0}};
}

double side_area(double top) {
    return pi * (1 + top) * std::hypot(1 - top, 1.0);
}

/// Cylinder, cone or frustum: a lower disc, perhaps an upper one, and the side.
Site on_tapered(Choice u, double top) {
    const double discs = pi * (1 + top * top);
    double at = u.z * (discs + side_area(top));
    if (at < pi) return on_disc(u, 1, 0);
    if (at < discs) return on_disc(u, top, 1);
    // From the lower edge on, the area up to y grows with y (2 - (1 - top) y).
    const double narrowing = 1 - top;
    const double share = u.x * (1 + top);
    const double y =
        narrowing < 1e-12 ? u.x : (1 - std::sqrt(std::max(0.0, 1 - narrowing * share))) / narrowing;
    const Vec3 out = on_circle(u.y);
    Vec3 p = (1 - narrowing * y) * out;
    p.y = y;
    return {p, glm::normalize(out + Vec3(0, narrowing, 0))};
}

Site on_torus(Choice u) {
    // Round the tube the area grows with the distance from the axis: a part of the points moves outwards.
    double tube = 2 * pi * u.x;
    if (u.z * 2 > 1 + torus_tube * std::cos(tube)) tube = pi - tube;
    const Vec3 out = on_circle(u.y);
    const Vec3 normal = std::cos(tube) * out + Vec3(0, std::sin(tube), 0);
    return {out + torus_tube * normal, normal};
}

Site site_of(PrimitiveKind kind, Choice u) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return on_triangle(u);
    case PrimitiveKind::sphere:
        return on_sphere(u);
    case PrimitiveKind::cube:
        return on_cube(u);
    case PrimitiveKind::torus:
        return on_torus(u);
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return on_tapered(u, top_radius(kind));
    case PrimitiveKind::plane:
        break;
    }
    GRAFTAL_CHECK(false, "a plane has no random points");
}

double area_of(PrimitiveKind kind) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return 0.75 * std::sqrt(3.0);
    case PrimitiveKind::sphere:
        return 4 * pi;
    case PrimitiveKind::cube:
        return 24;
    case PrimitiveKind::torus:
        return 4 * pi * pi * torus_tube;
    default:
        return pi * (1 + top_radius(kind) * top_radius(kind)) + side_area(top_radius(kind));
    }
}

/// The matrix of cofactors: |cofactors n| is how much area with the normal n grows. Also where A is singular.
Mat3 cofactors_of(const Mat3& a) {
    return {glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1])};
}

/// Evenly spread over the cube: steps by powers of 1/x, x^4 = x + 1.
Choice spread_choice(int i) {
    constexpr double step = 0.8191725133961645;
    const auto fraction = [&](double x) { return x - std::floor(x); };
    return {fraction(0.5 + step * i), fraction(0.5 + step * step * i),
            fraction(0.5 + step * step * step * i)};
}

constexpr int samples = 512;
using Normals = std::array<Vec3, samples>;

/// Normals at sites evenly spread over a canonical surface: of a graph's million parts each needs them.
const Normals& spread_normals(PrimitiveKind kind) {
    static std::mutex mutex;
    static std::map<PrimitiveKind, Normals> by_kind;
    const std::lock_guard lock(mutex);
    const auto [found, is_new] = by_kind.try_emplace(kind);
    for (int i = 0; is_new && i < samples; ++i)
        found->second[static_cast<std::size_t>(i)] = site_of(kind, spread_choice(i)).normal;
    return found->second;
}

} // namespace

PlacedSurface::PlacedSurface(PrimitiveKind kind, const Affine& world_from_primitive)
    : kind_(kind), map_(world_from_primitive), cofactors_(cofactors_of(map_.linear)) {
    GRAFTAL_CHECK(kind != PrimitiveKind::plane, "a plane has no area");
    double sum = 0;
    for (const Vec3& normal : spread_normals(kind))
        sum += glm::length(cofactors_ * normal);
    area_ = area_of(kind) * sum / samples;
    most_growth_ = norm(cofactors_);
}

Vec3 PlacedSurface::point(RandomStream& random) const {
    constexpr int most_tries = 1000;
    Site site;
    for (int i = 0; i < most_tries; ++i) {
        const double x = random.unit(), y = random.unit();
        site = site_of(kind_, {x, y, random.unit()});
        if (random.unit() * most_growth_ <= glm::length(cofactors_ * site.normal)) break;
    }
    return map_(site.point);
}

namespace {

double slant_of(const RunItem& item) {
    return std::hypot((1 - top_radius(item.kind)) * item.radius, glm::length(item.axis));
}

} // namespace

double area_of(const RunItem& item) {
    const double r = item.radius, ball = 4 * pi * r * r;
    if (item.kind == PrimitiveKind::sphere) return ball;
    const double top = top_radius(item.kind);
    return pi * r * r * (1 + top * top) + pi * r * (1 + top) * slant_of(item) + (item.ball ? ball : 0);
}

Vec3 point_of(const RunItem& item, RandomStream& random) {
    const double r = item.radius, top = top_radius(item.kind);
    const double u = random.unit(), v = random.unit();
    double at = random.unit() * area_of(item);
    const double ball = 4 * pi * r * r;
    if (item.kind == PrimitiveKind::sphere) return item.base + r * on_sphere({u, v, 0}).point;
    if (item.ball && at < ball) return item.base + item.axis + r * on_sphere({u, v, 0}).point;
    if (item.ball) at -= ball;
    const Affine place = run_from_body(item);
    if (at < pi * r * r) return place(on_disc({u, v, 0}, 1, 0).point);
    at -= pi * r * r;
    if (at < pi * r * r * top * top) return place(on_disc({u, v, 0}, top, 1).point);
    // As on_tapered() has it: the side's area up to y grows so however the axis stretches it.
    const double narrowing = 1 - top, share = u * (1 + top);
    const double y =
        narrowing < 1e-12 ? u : (1 - std::sqrt(std::max(0.0, 1 - narrowing * share))) / narrowing;
    Vec3 p = (1 - narrowing * y) * on_circle(v);
    p.y = y;
    return place(p);
}

} // namespace graftal
