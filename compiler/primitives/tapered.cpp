#include "compiler/primitives/tapered.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "compiler/primitives/round_mesh.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

using std::numbers::pi;

double side_area(double top) {
    return pi * (1 + top) * std::hypot(1 - top, 1.0);
}

} // namespace

double top_radius(const Primitive& primitive) {
    if (primitive == PrimitiveKind::frustum) return static_cast<double>(primitive.steps()) / frustum_steps;
    if (primitive == PrimitiveKind::cylinder) return 1;
    GRAFTAL_CHECK(primitive == PrimitiveKind::cone, "a primitive that does not taper");
    return 0;
}

Box tapered_box(const Primitive&) {
    return {{-1, 0, -1}, {1, 1, 1}};
}

/// Through the rims of both caps.
Ball tapered_ball(const Primitive& primitive) {
    const double top = top_radius(primitive), middle = top * top / 2;
    return {{0, middle, 0}, std::hypot(1.0, middle)};
}

std::vector<HullPiece> tapered_hull(const Primitive& primitive) {
    const Affine top = Affine::translate({0, 1, 0}) * Affine::scale(Vec3(top_radius(primitive)));
    return {{HullPiece::Kind::disc, Affine()}, {HullPiece::Kind::disc, top}};
}

/// A prism or pyramid in place of what is round about the y axis, as long around: the shadows of slender
/// ones, which are what there are most of, are as wide.
std::vector<ConvexPart> tapered_convex_parts(const Primitive& primitive) {
    constexpr int sides = 8;
    const double radius = pi / (sides * std::sin(pi / sides));
    ConvexPart part{{}, sides};
    for (const Affine& ring : {Affine(), Affine{Mat3(top_radius(primitive)), Vec3(0, 1, 0)}})
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * pi * i / sides;
            part.corners.push_back(ring(Vec3(radius * std::cos(angle), 0, radius * std::sin(angle))));
        }
    return {part};
}

double tapered_inner_radius(const Primitive&) {
    return 0.5;
}

Vec3 tapered_fixed_point(const Primitive&) {
    return {0, 0.5, 0};
}

bool tapered_keeps(const Primitive&, const Affine& map) {
    return turns_about_origin(map) && keeps_y_axis(map.linear) && map.linear[1][1] > 0;
}

double tapered_mesh_error(const Primitive&, int fineness) {
    return balanced_error(prism_sides(fineness));
}

/// u round the y axis, v along it.
TexturePoint tapered_texture_point(const Primitive&, const TextureSpace& space, Vec3 point) {
    return {turn_about_y(space, point), space.along * point.y};
}

double tapered_area(const Primitive& primitive) {
    const double top = top_radius(primitive);
    return pi * (1 + top * top) + side_area(top);
}

double tapered_volume(const Primitive& primitive) {
    const double top = top_radius(primitive);
    return pi / 3 * (1 + top + top * top);
}

/// A lower disc, perhaps an upper one, and the side.
SurfaceSite tapered_site(const Primitive& primitive, Vec3 u) {
    const double top = top_radius(primitive);
    const double discs = pi * (1 + top * top);
    const double at = u.z * (discs + side_area(top));
    if (at < pi) return disc_site(u, 1, 0);
    if (at < discs) return disc_site(u, top, 1);
    const double narrowing = 1 - top;
    const double y = height_on_side(u.x, top);
    const Vec3 out = circle_point(u.y);
    Vec3 p = (1 - narrowing * y) * out;
    p.y = y;
    return {p, glm::normalize(out + Vec3(0, narrowing, 0))};
}

int prism_sides(int fineness) {
    return 3 << fineness;
}

TessellatedPrimitive tapered_mesh(const Primitive& primitive, int fineness) {
    TessellatedPrimitive mesh;
    const double top = top_radius(primitive);
    const int n = prism_sides(fineness);
    const double radius = balanced_radius(n);
    for (int i = 0; i < n; ++i)
        for (const double y : {0.0, 1.0})
            add_vertex(mesh, (y > 0 ? top * radius : radius) * spoke(i, n) + Vec3(0, y, 0),
                       glm::normalize(spoke(i, n) + Vec3(0, 1 - top, 0)));
    for (int i = 0; i < n; ++i) {
        const auto low = static_cast<std::uint32_t>(2 * i);
        const auto next_low = static_cast<std::uint32_t>(2 * ((i + 1) % n));
        mesh.triangles.push_back({low, next_low, next_low + 1});
        mesh.triangles.push_back({low, next_low + 1, low + 1});
    }
    add_cap(mesh, n, top * radius, 1, true);
    add_cap(mesh, n, radius, 0, false);
    return mesh;
}

void add_cap(TessellatedPrimitive& mesh, int n, double radius, double y, bool facing_up) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < n; ++i)
        add_vertex(mesh, radius * spoke(i, n) + Vec3(0, y, 0), {0, facing_up ? 1 : -1, 0});
    const auto add = [&](int a, int b, int c) {
        if (!facing_up) std::swap(b, c);
        const auto corner = [&](int i) { return first + static_cast<std::uint32_t>(i % n); };
        mesh.triangles.push_back({corner(a), corner(b), corner(c)});
    };
    const int third = n / 3;
    add(0, third, 2 * third);
    for (int arc = third; arc > 1; arc /= 2)
        for (int i = 0; i < n; i += arc)
            add(i, i + arc / 2, i + arc);
}

SurfaceSite disc_site(Vec3 u, double radius, double y) {
    Vec3 p = radius * std::sqrt(u.x) * circle_point(u.y);
    p.y = y;
    return {p, {0, y > 0 ? 1 : -1, 0}};
}

/// From the lower edge on, the area up to y grows with y (2 - (1 - top) y).
double height_on_side(double u, double top) {
    const double narrowing = 1 - top;
    const double share = u * (1 + top);
    return narrowing < 1e-12 ? u : (1 - std::sqrt(std::max(0.0, 1 - narrowing * share))) / narrowing;
}

} // namespace graftal
