#include "runtime/export/shape_mesh.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/normal_map.h"

namespace graftal {

namespace {

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
    if (!has_picture(look) && !mesh.normals.empty())
        return known_[key] = {mesh.vertices, mesh.normals, {}, mesh.triangles};
    return known_[key] = cornered(mesh, shape.primitive, has_picture(look) ? &space : nullptr);
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
