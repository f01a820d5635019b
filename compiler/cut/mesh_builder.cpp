#include "compiler/cut/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/cut/tessellate.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// Positions that round to the same multiple of this, in body units, are one vertex: a few steps of
/// POV-Ray's float32.
constexpr double weld_unit = 1.0 / (1 << 21);
/// The cube's.
constexpr std::size_t most_flat_vertices = 8;

std::uint64_t mix(std::uint64_t h, std::uint64_t value) {
    h = (h ^ value) * 0x9E3779B97F4A7C15ull;
    return h ^ (h >> 31);
}

template<typename Number> std::size_t hash_of(const std::array<Number, 3>& numbers) {
    std::uint64_t h = 0;
    for (const Number number : numbers)
        h = mix(h, static_cast<std::uint64_t>(number));
    return h;
}

/// Parity of the order of three different numbers; turning a triangle over changes it.
bool is_odd(const std::array<std::uint32_t, 3>& c) {
    return ((c[0] > c[1]) + (c[0] > c[2]) + (c[1] > c[2])) % 2 == 1;
}

} // namespace

std::size_t MeshBuilder::Hash::operator()(const GridPoint& point) const {
    return hash_of(point.cell);
}
std::size_t MeshBuilder::Hash::operator()(const Face& face) const {
    return hash_of(face.corners);
}

void MeshBuilder::add(PrimitiveKind kind, int fineness, const Affine& body_from_leaf, std::size_t leaf) {
    const bool mirrored = glm::determinant(body_from_leaf.linear) < 0;
    const bool curved = !tessellated(kind, fineness).normals.empty();
    GRAFTAL_CHECK(smooth_ || !curved, "curved primitive in a flat mesh");
    if (curved)
        add_smooth(kind, fineness, body_from_leaf, leaf);
    else if (smooth_)
        add_facets(kind, body_from_leaf, mirrored, leaf);
    else
        add_flat(kind, body_from_leaf, mirrored, leaf);
}

void MeshBuilder::add_smooth(PrimitiveKind kind, int fineness, const Affine& body_from_leaf,
                             std::size_t leaf) {
    const TessellatedPrimitive& shape = tessellated(kind, fineness);
    const Mat3 normal_map = glm::transpose(glm::inverse(body_from_leaf.linear));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
        mesh.vertices.push_back(body_from_leaf(shape.vertices[i]));
        mesh.normals.push_back(glm::normalize(normal_map * shape.normals[i]));
    }
    for (const auto& t : shape.triangles)
        push({first + t[0], first + t[1], first + t[2]}, leaf);
}

void MeshBuilder::add_facets(PrimitiveKind kind, const Affine& body_from_leaf, bool mirrored,
                             std::size_t leaf) {
    const TessellatedPrimitive& shape = tessellated(kind, 0);
    for (const auto& triangle : shape.triangles) {
        std::array<Vec3, 3> corner;
        for (int k = 0; k < 3; ++k)
            corner[k] = body_from_leaf(shape.vertices[triangle[k]]);
        const Vec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        const double length = glm::length(normal);
        if (!(length > 0)) continue;
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const Vec3& point : corner) {
            mesh.vertices.push_back(point);
            mesh.normals.push_back((mirrored ? -normal : normal) / length);
        }
        push({first, first + 1, first + 2}, leaf);
    }
}

void MeshBuilder::add_flat(PrimitiveKind kind, const Affine& body_from_leaf, bool mirrored,
                           std::size_t leaf) {
    const TessellatedPrimitive& shape = tessellated(kind, 0);
    std::vector<std::uint32_t> index;
    for (const Vec3& vertex : shape.vertices)
        index.push_back(welded(body_from_leaf(vertex)));
    for (const auto& t : shape.triangles) {
        std::array<std::uint32_t, 3> corners = {index[t[0]], index[t[1]], index[t[2]]};
        if (mirrored) std::swap(corners[1], corners[2]);
        const bool degenerate =
            corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2];
        if (!degenerate) push_unless_hidden(corners, kind == PrimitiveKind::cube, leaf);
    }
}

std::uint32_t MeshBuilder::welded(Vec3 point) {
    GridPoint cell;
    for (int k = 0; k < 3; ++k)
        cell.cell[k] = static_cast<std::int64_t>(std::floor(point[k] / weld_unit + 0.5));
    const auto [place, added] = vertex_at_.emplace(cell, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(point);
    return place->second;
}

void MeshBuilder::push_unless_hidden(std::array<std::uint32_t, 3> corners, bool solid, std::size_t leaf) {
    Face face{corners};
    std::sort(face.corners.begin(), face.corners.end());
    const auto [place, added] = triangle_at_.emplace(face, static_cast<std::uint32_t>(mesh.triangles.size()));
    if (added) {
        push(corners, leaf);
        origin_.push_back({solid, false});
        return;
    }
    Origin& other = origin_[place->second];
    const bool back_to_back = is_odd(corners) != is_odd(mesh.triangles[place->second]);
    if (solid && other.solid && back_to_back) other.hidden = true;
}

void MeshBuilder::push(std::array<std::uint32_t, 3> corners, std::size_t leaf) {
    mesh.triangles.push_back(corners);
    leaf_of_triangle.push_back(leaf);
}

void MeshBuilder::finish() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!smooth_ && origin_[i].hidden) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        leaf_of_triangle[kept++] = leaf_of_triangle[i];
    }
    mesh.triangles.resize(kept);
    leaf_of_triangle.resize(kept);
    drop_unused_vertices();
}

void MeshBuilder::drop_unused_vertices() {
    constexpr std::uint32_t unused = UINT32_MAX;
    std::vector<std::uint32_t> renumbered(mesh.vertices.size(), unused);
    std::vector<Vec3> vertices, normals;
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) {
            if (renumbered[corner] == unused) {
                renumbered[corner] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(mesh.vertices[corner]);
                if (smooth_) normals.push_back(mesh.normals[corner]);
            }
            corner = renumbered[corner];
        }
    mesh.vertices = std::move(vertices);
    mesh.normals = std::move(normals);
}

} // namespace graftal
