#include "runtime/export/shape_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/normal_map.h"

namespace graftal {

namespace {

/// Corners that lie nearer to each other than this share of the mesh's size are one: the poles of some meshes
/// are many corners, which rounding has taken apart.
constexpr double one_corner = 1e-9;

/// Gives them one place, to the last bit. O(n log n).
void weld(std::vector<Vec3>& vertices) {
    Box box;
    for (const Vec3& vertex : vertices)
        box.include(vertex);
    if (box.empty()) return;
    const double near = one_corner * largest_entry(box.size());
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(vertices[a].x, a) < std::tie(vertices[b].x, b);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const Vec3 apart = vertices[order[j]] - vertices[order[i]];
            if (!(apart.x <= near)) break;
            if (largest_entry(apart) <= near) vertices[order[j]] = vertices[order[i]];
        }
}

/// Each triangle has its own corners.
ShapeMesh cornered(const TessellatedPrimitive& shape, const Primitive& primitive, const TextureSpace* space) {
    ShapeMesh mesh;
    for (const auto& triangle : shape.triangles) {
        std::array<Vec3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k)
            corner[k] = shape.vertices[triangle[k]];
        const Vec3 facet = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (std::size_t k = 0; k < 3; ++k) {
            mesh.vertices.push_back(corner[k]);
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
    ShapeMesh& made = known_[key];
    if (!has_picture(look) && !mesh.normals.empty())
        made = {mesh.vertices, mesh.normals, {}, mesh.triangles};
    else
        made = cornered(mesh, shape.primitive, has_picture(look) ? &space : nullptr);
    weld(made.vertices);
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
