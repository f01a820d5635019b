#include "compiler/chaos/surface.h"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/primitives/primitive_cache.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/tapered.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr double pi = std::numbers::pi;

/// Evenly spread over the cube: steps by powers of 1/x, x^4 = x + 1.
Vec3 spread_choice(int i) {
    constexpr double step = 0.8191725133961645;
    const auto fraction = [&](double x) { return x - std::floor(x); };
    return {fraction(0.5 + step * i), fraction(0.5 + step * step * i),
            fraction(0.5 + step * step * step * i)};
}

constexpr int samples = 512;
using Normals = std::array<Vec3, samples>;

/// Normals at sites evenly spread over a surface: of a graph's million parts each needs them.
const Normals& spread_normals(const Primitive& primitive) {
    static PrimitiveCache<Normals> normals;
    return normals.get(primitive, [&] {
        Normals spread;
        for (int i = 0; i < samples; ++i)
            spread[static_cast<std::size_t>(i)] =
                traits_of(primitive).site(primitive, spread_choice(i)).normal;
        return spread;
    });
}

} // namespace

Mat3 cofactors_of(const Mat3& a) {
    return {glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1])};
}

PlacedSurface::PlacedSurface(const Primitive& primitive, const Affine& world_from_primitive)
    : primitive_(primitive), map_(world_from_primitive), cofactors_(cofactors_of(map_.linear)) {
    GRAFTAL_CHECK(traits_of(primitive).bounded, "a plane has no area");
    double sum = 0;
    for (const Vec3& normal : spread_normals(primitive))
        sum += glm::length(cofactors_ * normal);
    area_ = traits_of(primitive).area(primitive) * sum / samples;
    most_growth_ = norm(cofactors_);
}

Vec3 PlacedSurface::point(RandomStream& random) const {
    constexpr int most_tries = 1000;
    SurfaceSite site;
    for (int i = 0; i < most_tries; ++i) {
        const double x = random.unit(), y = random.unit();
        site = traits_of(primitive_).site(primitive_, {x, y, random.unit()});
        if (random.unit() * most_growth_ <= glm::length(cofactors_ * site.normal)) break;
    }
    return map_(site.point);
}

namespace {

Vec3 on_sphere(double u, double v) {
    return sphere_traits.site(PrimitiveKind::sphere, {u, v, 0}).point;
}

double slant_of(const RunItem& item) {
    return std::hypot((1 - item.shape.top_radius()) * item.radius, glm::length(item.axis));
}

double whole_of(const ItemAreas& areas) {
    return areas.body + areas.ball;
}

} // namespace

ItemAreas areas_of(const RunItem& item) {
    const double r = item.radius, ball = 4 * pi * r * r;
    if (item.shape.is_sphere()) return {ball, 0};
    const double top = item.shape.top_radius();
    return {pi * r * r * (1 + top * top) + pi * r * (1 + top) * slant_of(item), item.ball ? ball : 0};
}

std::vector<double> areas_of_items(const PackedEdges& edges) {
    std::vector<double> areas;
    areas.reserve(edges.item_count());
    for (std::size_t i = 0; i < edges.item_count(); ++i)
        areas.push_back(whole_of(areas_of((*edges.run)[i])));
    return areas;
}

Vec3 point_of_item(const PackedEdges& edges, std::size_t number, RandomStream& random) {
    const RunItem& item = (*edges.run)[number];
    const double r = item.radius, top = item.shape.top_radius();
    const double u = random.unit(), v = random.unit();
    double at = random.unit() * whole_of(areas_of(item));
    const double ball = 4 * pi * r * r;
    if (item.shape.is_sphere()) return item.base + r * on_sphere(u, v);
    if (item.ball && at < ball) return item.base + item.axis + r * on_sphere(u, v);
    if (item.ball) at -= ball;
    const Affine place = run_from_body(item);
    if (at < pi * r * r) return place(disc_site({u, v, 0}, 1, 0).point);
    at -= pi * r * r;
    if (at < pi * r * r * top * top) return place(disc_site({u, v, 0}, top, 1).point);
    const double y = height_on_side(u, top);
    Vec3 p = (1 - (1 - top) * y) * circle_point(v);
    p.y = y;
    return place(p);
}

} // namespace graftal
