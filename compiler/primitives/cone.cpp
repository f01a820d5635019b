#include <glm/geometric.hpp>

#include "compiler/primitives/primitive.h"
#include "compiler/primitives/round_mesh.h"
#include "compiler/primitives/support_points.h"
#include "compiler/primitives/tapered.h"

namespace graftal {
namespace {

Vec3 support_point(const Primitive&, Vec3 direction) {
    return farther(direction, Vec3(0, 1, 0), farthest_on_circle(direction, 0));
}

std::vector<HullPiece> hull(const Primitive&) {
    return {{HullPiece::Kind::disc, Affine()}, {HullPiece::Kind::point, Affine::translate({0, 1, 0})}};
}

TessellatedPrimitive mesh(const Primitive&, int fineness) {
    TessellatedPrimitive mesh;
    const int n = prism_sides(fineness);
    const double radius = balanced_radius(n);
    const auto outward = [](Vec3 direction) { return glm::normalize(direction + Vec3(0, 1, 0)); };
    for (int i = 0; i < n; ++i)
        add_vertex(mesh, radius * spoke(i, n), outward(spoke(i, n)));
    for (int i = 0; i < n; ++i) {
        // The apex has no normal of its own: each side has one there, that of its middle.
        const std::uint32_t apex = add_vertex(mesh, {0, 1, 0}, outward(spoke(2 * i + 1, 2 * n)));
        mesh.triangles.push_back(
            {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>((i + 1) % n), apex});
    }
    add_cap(mesh, n, radius, 0, false);
    return mesh;
}

bool intersect(const Primitive&, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    return intersect_tapered(0, ray, range, hit);
}

} // namespace

constinit const PrimitiveTraits cone_traits =
    tapered_row({.support_point = support_point, .hull = hull, .mesh = mesh, .intersect = intersect});

} // namespace graftal
