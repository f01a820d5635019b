#pragma once

// Parts shared by primitives that are many triangles: the mesh of a file, and surfaces that become a mesh
// when they are made.

#include <array>
#include <string>
#include <vector>

#include "compiler/primitives/mesh_file.h"
#include "compiler/primitives/shape_parts.h"
#include "compiler/primitives/triangle_tree.h"

namespace graftal {

class TriangleMesh : public Shape {
  public:
    /// Requires at least one triangle; every triangle has an area, and coordinates are finite.
    TriangleMesh(std::string name, MeshData mesh);

    MeshData data;
    TriangleTree tree;
    Box box;
    AreaSampler areas;
};

/// The mesh without triangles that have no area or repeat the corners, in order, of an earlier one. Vertices
/// that no triangle has then go too. Normals get unit length; one that has none is that of a triangle at the
/// vertex. Requires finite numbers. `keeps_repeats`: only triangles without area go, so that what is closed
/// stays closed where it lies on itself.
MeshData without_slivers(const MeshData& data, bool keeps_repeats = false);

/// The row of a kind whose shapes are all TriangleMesh, `arguments` and `make` apart.
namespace triangle_mesh {

Box box(const Primitive& primitive);
Ball ball(const Primitive& primitive);
Vec3 support_point(const Primitive& primitive, Vec3 direction);
double reach(const Primitive& primitive, Vec3 direction);
std::vector<HullPiece> hull(const Primitive& primitive);
std::vector<ConvexPart> convex_parts(const Primitive& primitive);
double inner_radius(const Primitive& primitive);
bool keeps(const Primitive& primitive, const Affine& map);
TessellatedPrimitive mesh(const Primitive& primitive, int fineness);
TexturePoint texture_point(const Primitive& primitive, const TextureSpace& space, Vec3 point);
std::array<TexturePoint, 3> texture_triangle(const Primitive& primitive, const TextureSpace& space,
                                             const std::array<Vec3, 3>& points);
double area(const Primitive& primitive);
SurfaceSite site(const Primitive& primitive, Vec3 choice);
bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit);
/// intersect() within `most_steps` (TriangleTree::meet()).
bool intersect_within(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit,
                      std::uint64_t most_steps);

constexpr PrimitiveTraits traits(PrimitiveArguments arguments = {},
                                 std::optional<Primitive> (*make)(std::span<const double>,
                                                                  std::string&) = nullptr) {
    return flat_row(
        {
            .arguments = arguments,
            .make = make,
            .box = box,
            .ball = ball,
            .support_point = support_point,
            .reach = reach,
            .inner_radius = inner_radius,
            .keeps = keeps,
            .mesh = mesh,
            .texture_point = texture_point,
            .texture_triangle = texture_triangle,
            .area = area,
            .site = site,
            .intersect = intersect,
            .intersect_within = intersect_within,
        },
        {.hull = hull, .convex_parts = convex_parts});
}

} // namespace triangle_mesh

} // namespace graftal
