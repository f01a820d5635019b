#include "runtime/export/united_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/environment/cell_grid.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/triangle_mesh.h"

namespace graftal {

namespace {

constexpr std::size_t most_facets_of_node = 10'000;
/// Most facets of a scene that are united; each takes about 500 bytes.
constexpr std::size_t most_facets = 500'000;
/// Squares of areas are numbers within these sizes.
constexpr double least_mesh = 1e-30, largest_mesh = 1e30;
/// Corners nearer to each other than this share of the mesh's size are one.
constexpr double one_vertex = 1e-9;
/// The least cosine between the normals of facets in parallel planes.
constexpr double one_plane = 1 - 1e-12;

/// Parts of a node, by their numbers.
using Group = std::vector<std::size_t>;

bool is_facet(const UnfoldedScene& scene, const ScenePart& part) {
    const SceneNode& leaf = scene.nodes[part.node];
    if (!leaf.shape || scene.shapes[*leaf.shape].primitive != PrimitiveKind::triangle) return false;
    return !leaf.look.material || scene.materials[*leaf.look.material].texture.empty();
}

/// Facets of one look, in the order of the first of each.
std::vector<Group> groups_of(const UnfoldedScene& scene, const SceneNode& node) {
    using Key = std::pair<SceneId, std::optional<std::array<double, 3>>>; // the leaf, and the colour on it
    std::map<Key, std::size_t> number_of;
    std::vector<Group> groups;
    for (std::size_t i = 0; i < node.parts.size(); ++i) {
        const ScenePart& part = node.parts[i];
        if (!is_facet(scene, part)) continue;
        Key key{part.node, {}};
        if (part.colour) key.second = {part.colour->r, part.colour->g, part.colour->b};
        const auto [known, is_new] = number_of.try_emplace(key, groups.size());
        if (is_new) groups.emplace_back();
        groups[known->second].push_back(i);
    }
    std::erase_if(groups, [](const Group& group) { return group.size() < 2; });
    return groups;
}

/// The corners of a facet, counter-clockwise seen from where its normal points.
Triangle corners_of(const Affine& place) {
    const TessellatedPrimitive& unit = tessellated(PrimitiveKind::triangle, 0);
    Triangle facet{place(unit.vertices[0]), place(unit.vertices[1]), place(unit.vertices[2])};
    if (glm::determinant(place.linear) < 0) std::swap(facet[1], facet[2]);
    return facet;
}

/// A triangle for each facet; corners that meet are one vertex where their facets lie in parallel planes.
/// Nothing where the numbers of a mesh do not hold it.
std::optional<MeshData> welded(const std::vector<Triangle>& facets) {
    Box box;
    for (const Triangle& facet : facets)
        for (const Vec3& corner : facet)
            box.include(corner);
    const double size = largest_entry(box.size());
    if (!(size >= least_mesh && size <= largest_mesh)) return std::nullopt;
    const double near = one_vertex * size;
    constexpr double cell = 4; // few reach into a neighbour, and few corners have room in one
    CellGrid corners(cell * near);
    MeshData mesh;
    for (const Triangle& facet : facets) {
        const Vec3 across = area_normal(facet);
        const double area = glm::length(across);
        const Vec3 normal = area > 0 ? across / area : Vec3(0.0);
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            triangle[k] = static_cast<std::uint32_t>(mesh.vertices.size());
            corners.near(facet[k] - box.min, near, [&](std::uint32_t other) {
                const bool is_it = largest_entry(facet[k] - mesh.vertices[other]) <= near &&
                                   glm::dot(normal, mesh.normals[other]) >= one_plane;
                if (is_it) triangle[k] = other;
                return !is_it;
            });
            if (triangle[k] < mesh.vertices.size()) continue;
            corners.add(facet[k] - box.min, triangle[k]);
            mesh.vertices.push_back(facet[k]);
            mesh.normals.push_back(normal);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// Triangles that hang together by their sides, as lists of two and more in the order of the first of each.
std::vector<Group> polygons_of(const MeshData& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> triangle_at; // a side
    std::vector<std::size_t> root(mesh.triangles.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (root[i] != i)
            i = root[i] = root[root[i]];
        return i;
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto side = std::minmax(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]);
            const std::size_t one = find(triangle_at.try_emplace(side, i).first->second), other = find(i);
            root[std::max(one, other)] = std::min(one, other);
        }
    std::map<std::size_t, Group> by_first;
    for (std::size_t i = 0; i < root.size(); ++i)
        by_first[find(i)].push_back(i);
    std::vector<Group> polygons;
    for (auto& [first, polygon] : by_first)
        if (polygon.size() > 1) polygons.push_back(std::move(polygon));
    return polygons;
}

/// Some triangles of a mesh; nothing where none has an area.
std::optional<MeshData> part_of(const MeshData& mesh, const Group& triangles) {
    MeshData part;
    std::map<std::uint32_t, std::uint32_t> number;
    for (const std::size_t i : triangles) {
        std::array<std::uint32_t, 3>& triangle = part.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[i][k];
            const auto next = static_cast<std::uint32_t>(part.vertices.size());
            const auto [known, is_new] = number.try_emplace(vertex, next);
            triangle[k] = known->second;
            if (!is_new) continue;
            part.vertices.push_back(mesh.vertices[vertex]);
            part.normals.push_back(mesh.normals[vertex]);
        }
    }
    part = without_slivers(part, true);
    return part.triangles.empty() ? std::nullopt : std::optional(std::move(part));
}

/// Puts a mesh in the place of parts of a node. Marks parts that go.
void replace(UnfoldedScene& scene, SceneId id, const Group& parts, MeshData mesh, std::vector<bool>& goes) {
    const auto shape = static_cast<std::uint32_t>(scene.shapes.size());
    scene.shapes.push_back({mesh_primitive(fmt::format("facets {}", shape), std::move(mesh)), 0});
    SceneNode& node = scene.nodes[id];
    ScenePart& first = node.parts[parts.front()];
    SceneNode leaf = scene.nodes[first.node];
    leaf.shape = shape;
    leaf.name = node.name;
    if (parts.size() == node.parts.size() && !first.colour) {
        node = std::move(leaf);
        return;
    }
    first.node = static_cast<SceneId>(scene.nodes.size());
    first.node_from_part = {};
    for (std::size_t i = 1; i < parts.size(); ++i)
        goes[parts[i]] = true;
    scene.nodes.push_back(std::move(leaf));
}

void unite(UnfoldedScene& scene, SceneId id, const std::vector<Group>& groups) {
    std::vector<bool> goes(scene.nodes[id].parts.size(), false);
    for (const Group& group : groups) {
        std::vector<Triangle> facets;
        for (const std::size_t part : group)
            facets.push_back(corners_of(scene.nodes[id].parts[part].node_from_part));
        const std::optional<MeshData> mesh = welded(facets);
        if (!mesh) continue;
        for (const Group& polygon : polygons_of(*mesh)) {
            std::optional<MeshData> own = part_of(*mesh, polygon);
            if (!own) continue;
            Group parts;
            for (const std::size_t i : polygon)
                parts.push_back(group[i]);
            replace(scene, id, parts, std::move(*own), goes);
        }
    }
    std::vector<ScenePart>& parts = scene.nodes[id].parts;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!goes[i]) parts[kept++] = parts[i];
    parts.resize(kept);
}

} // namespace

void unite_facets(UnfoldedScene& scene) {
    std::size_t left = most_facets;
    for (const SceneId id : std::vector<SceneId>(scene.masters_first)) {
        if (scene.nodes[id].parts.size() < 2) continue;
        const std::vector<Group> groups = groups_of(scene, scene.nodes[id]);
        std::size_t count = 0;
        for (const Group& group : groups)
            count += group.size();
        if (count > std::min(left, most_facets_of_node)) continue;
        left -= count;
        unite(scene, id, groups);
    }
    sort_masters_first(scene);
    std::vector<bool> used(scene.nodes.size(), false);
    used[scene.root] = true;
    for (const SceneNode& node : scene.nodes)
        for (const ScenePart& part : node.parts)
            used[part.node] = true;
    std::erase_if(scene.masters_first, [&](SceneId id) { return !used[id]; });
}

} // namespace graftal
