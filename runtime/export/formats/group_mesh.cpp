#include "runtime/export/formats/group_mesh.h"

#include <map>
#include <tuple>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "runtime/export/formats/flat_files.h"

namespace graftal {

namespace {

std::array<float, 3> floats(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

} // namespace

Rgb plain_colour(const UnfoldedScene& scene, const std::optional<MaterialId>& material) {
    return material ? scene.materials[*material].rgb : SceneLook().inherited;
}

std::vector<GroupSurface> surfaces_of(const UnfoldedScene& scene, SceneId node, ShapeMeshes& meshes,
                                      ColoursOf colours) {
    std::vector<GroupSurface> surfaces;
    std::map<std::tuple<std::int64_t, bool, bool, std::array<std::uint8_t, 3>>, std::size_t> by_key;
    walk_leaves(scene, node, {}, {}, [&](const SceneLeaf& leaf) {
        const SceneLook& look = scene.nodes[leaf.node].look;
        const Rgb colour = look.colour();
        const bool coloured =
            glm::any(glm::greaterThan(glm::abs(colour - plain_colour(scene, look.material)), Rgb(0.5 / 255)));
        const std::int64_t material = look.material ? static_cast<std::int64_t>(*look.material) : -1;
        const bool own = coloured && colours == ColoursOf::surfaces;
        const PlacedShape placed(meshes.of(leaf.shape, look), leaf.world_from_shape);
        const auto [known, is_new] =
            by_key.try_emplace({material, coloured, placed.mesh->uv.empty(),
                                own ? srgb_bytes(colour) : std::array<std::uint8_t, 3>{}},
                               surfaces.size());
        if (is_new) surfaces.push_back({.material = look.material, .coloured = coloured});
        GroupSurface& surface = surfaces[known->second];
        const auto first = static_cast<std::uint32_t>(surface.vertices.size());
        for (std::size_t i = 0; i < placed.mesh->vertices.size(); ++i) {
            surface.vertices.push_back(floats(placed.vertex(i)));
            surface.normals.push_back(floats(placed.normal(i)));
            if (coloured && (!own || surface.colours.empty())) surface.colours.push_back(colour);
        }
        for (const auto& uv : placed.mesh->uv)
            surface.uv.push_back({static_cast<float>(uv[0]), static_cast<float>(uv[1])});
        for (std::size_t i = 0; i < placed.mesh->triangles.size(); ++i) {
            std::array<std::uint32_t, 3> t = placed.triangle(i);
            for (std::uint32_t& corner : t)
                corner += first;
            const auto at = [&](int k) { return surface.vertices[t[static_cast<std::size_t>(k)]]; };
            if (at(0) != at(1) && at(1) != at(2) && at(2) != at(0)) surface.triangles.push_back(t);
        }
        return true;
    });
    std::erase_if(surfaces, [](const GroupSurface& surface) { return surface.triangles.empty(); });
    return surfaces;
}

} // namespace graftal
