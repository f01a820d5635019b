#include "runtime/export/shape_mesh.h"

#include <bit>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/environment/cell_grid.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/id_table.h"
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

/// The numbers of a vertex, to be compared.
std::array<double, 8> numbers_of(const ShapeMesh& mesh, std::size_t i) {
    const Vec3 &at = mesh.vertices[i], &normal = mesh.normals[i];
    return {at.x, at.y, at.z, normal.x, normal.y, normal.z, mesh.uv[i][0], mesh.uv[i][1]};
}

/// Makes one vertex of corners that agree in place, normal and texture point, in the order of the first of
/// them: only those along the seams of a picture stay apart. O(n). Requires texture points.
void unite_equal_corners(ShapeMesh& mesh) {
    IdTable known;
    std::uint32_t kept = 0;
    std::vector<std::uint32_t> vertex_of(mesh.vertices.size());
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
        const std::array<double, 8> numbers = numbers_of(mesh, i);
        std::uint64_t hash = 0;
        for (const double number : numbers)
            hash = mixed(hash, std::bit_cast<std::uint64_t>(number + 0.0)); // zeros are equal
        vertex_of[i] = known.find_or_add(
            hash, kept, [&](std::uint32_t other) { return numbers_of(mesh, other) == numbers; });
        if (vertex_of[i] != kept) continue;
        mesh.vertices[kept] = mesh.vertices[i];
        mesh.normals[kept] = mesh.normals[i];
        mesh.uv[kept] = mesh.uv[i];
        ++kept;
    }
    mesh.vertices.resize(kept);
    mesh.normals.resize(kept);
    mesh.uv.resize(kept);
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle)
            corner = vertex_of[corner];
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

bool ShapeMeshes::has_places(const Primitive& primitive, const SceneLook& look) const {
    if (look.material && !scene_.materials[*look.material].texture.empty()) return true;
    return places_ == PicturePlaces::of_surfaces && has_texture_points(primitive);
}

const ShapeMesh& ShapeMeshes::of(std::uint32_t number, const SceneLook& look) {
    const SceneShape& shape = scene_.shapes[number];
    TextureSpace space;
    Key key{number, 0, 0};
    const bool placed = has_places(shape.primitive, look);
    if (placed) {
        const double around = look.material ? scene_.materials[*look.material].around : 1;
        space = texture_space(shape.primitive, around, look.turns);
        key = {number, space.around, space.along};
    }
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    const TessellatedPrimitive& mesh = tessellated(shape.primitive, shape.fineness);
    std::vector<Vec3> places = welded(mesh.vertices);
    ShapeMesh& made = known_[key];
    if (!placed && !mesh.normals.empty())
        made = {std::move(places), mesh.normals, {}, mesh.triangles};
    else
        made = cornered(mesh, places, shape.primitive, placed ? &space : nullptr);
    if (!made.uv.empty()) unite_equal_corners(made);
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
