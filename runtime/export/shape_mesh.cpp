#include "runtime/export/shape_mesh.h"

#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/environment/cell_grid.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/normal_map.h"

namespace graftal {

namespace {

/// Corners that lie nearer to each other than this share of the mesh's size are one: the poles of some meshes
/// are many corners, which rounding has taken apart.
constexpr double one_corner = 1e-9;

/// Welds vertices: those that are one corner get one place, the first's. O(n).
std::vector<Vec3> welded(const std::vector<Vec3>& vertices) {
    Box box;
    for (const Vec3& vertex : vertices)
        box.include(vertex);
    const double near = box.empty() ? 0 : one_corner * largest_entry(box.size());
    if (!(near > 0)) return vertices;
    std::vector<Vec3> places;
    places.reserve(vertices.size());
    constexpr double cell = 4; // few reach into a neighbour, and few corners have room in one
    CellGrid corners(cell * near);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        places.push_back(vertices[i]);
        bool is_new = true;
        corners.near(vertices[i] - box.min, near, [&](std::uint32_t corner) {
            if (largest_entry(vertices[i] - places[corner]) > near) return true;
            places[i] = places[corner];
            return is_new = false;
        });
        if (is_new) corners.add(vertices[i] - box.min, i);
    }
    return places;
}

/// Each triangle has its own corners. `places`: of the shape's vertices.
ShapeMesh cornered(const TessellatedPrimitive& shape, const std::vector<Vec3>& places,
                   const Primitive& primitive, const TextureSpace* space) {
    ShapeMesh mesh;
    for (const auto& triangle : shape.triangles) {
        std::array<Vec3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k)
            corner[k] = shape.vertices[triangle[k]];
        const Vec3 facet = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (std::size_t k = 0; k < 3; ++k) {
            mesh.vertices.push_back(places[triangle[k]]);
            mesh.normals.push_back(shape.normals.empty() ? facet : shape.normals[triangle[k]]);
        }
        if (space)
            for (const TexturePoint& point : texture_coordinates(primitive, *space, corner))
                mesh.uv.push_back(point);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

} // namespace

const ShapeMesh& ShapeMeshes::of(std::uint32_t number, const SceneLook& look) {
    const SceneShape& shape = scene_.shapes[number];
    TextureSpace space;
    Key key{number, 0, 0};
    if (has_picture(look)) {
        space = texture_space(shape.primitive, scene_.materials[*look.material].around, look.turns);
        key = {number, space.around, space.along};
    }
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    const TessellatedPrimitive& mesh = tessellated(shape.primitive, shape.fineness);
    std::vector<Vec3> places = welded(mesh.vertices);
    ShapeMesh& made = known_[key];
    if (!has_picture(look) && !mesh.normals.empty())
        made = {std::move(places), mesh.normals, {}, mesh.triangles};
    else
        made = cornered(mesh, places, shape.primitive, has_picture(look) ? &space : nullptr);
    return made;
}

PlacedShape::PlacedShape(const ShapeMesh& shape_mesh, const Affine& at)
    : mesh(&shape_mesh), place(at), normal_by_normal(normal_map(at.linear)),
      mirrored(glm::determinant(at.linear) < 0) {}

Vec3 PlacedShape::normal(std::size_t i) const {
    const Vec3 normal = normal_by_normal * mesh->normals[i];
    const double length = glm::length(normal);
    return length > 0 ? normal / length : mesh->normals[i];
}

} // namespace graftal
