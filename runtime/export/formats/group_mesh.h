#pragma once

#include <array>
#include <vector>

#include "runtime/export/mesh_groups.h"
#include "runtime/export/shape_mesh.h"

namespace graftal {

/// The part of a mesh that has one material, and places on pictures everywhere or nowhere.
struct GroupSurface {
    std::optional<MaterialId> material;
    bool coloured = false; ///< by vertex, in place of the material's own colour
    std::vector<std::array<float, 3>> vertices, normals;
    std::vector<std::array<float, 2>> uv; ///< empty, or one a vertex; v upwards
    std::vector<Rgb> colours;             ///< linear; one a vertex, or a single one (ColoursOf::surfaces)
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The places where formats have colours.
enum class ColoursOf { vertices, surfaces };

/// The leaves below a node as surfaces, in the node's frame: with colours by vertex, or each in one colour
/// (to 8 bits), its first. Corners that rounding brings together make no triangle. Requires resolved looks.
std::vector<GroupSurface> surfaces_of(const UnfoldedScene& scene, SceneId node, ShapeMeshes& meshes,
                                      ColoursOf colours = ColoursOf::vertices);

/// The colour of what has this material, or none.
Rgb plain_colour(const UnfoldedScene& scene, const std::optional<MaterialId>& material);

} // namespace graftal
