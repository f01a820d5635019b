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

template<typename Number, std::size_t n> std::size_t hash_of(const std::array<Number, n>& numbers) {
    std::uint64_t h = 0;
    for (const Number number : numbers)
        h = mix(h, static_cast<std::uint64_t>(number));
    return h;
}

/// The facets of a flat primitive, counter-clockwise seen from outside, over the corners that tessellated()
/// has; four-cornered ones are cut from the first to the third corner, as there.
std::vector<std::vector<std::uint32_t>> facets_of(PrimitiveKind kind) {
    if (kind == PrimitiveKind::triangle) return {{0, 1, 2}};
    std::vector<std::vector<std::uint32_t>> quads;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, w = 1u << axis;
        quads.push_back({w, w | u, w | u | v, w | v});
        quads.push_back({0, v, u | v, u});
    }
    return quads;
}

/// Whether the corners run from the least towards its smaller neighbour: turning a facet over changes it.
bool turns_to_smaller(const std::array<std::uint32_t, 4>& c) {
    const std::size_t count = c[3] == UINT32_MAX ? 3 : 4;
    const std::size_t least =
        static_cast<std::size_t>(std::min_element(c.begin(), c.begin() + count) - c.begin());
    return c[(least + 1) % count] < c[(least + count - 1) % count];
}

} // namespace

std::size_t MeshBuilder::Hash::operator()(const GridPoint& point) const {
    return hash_of(point.cell);
}
std::size_t MeshBuilder::Hash::operator()(const FacetKey& key) const {
    return hash_of(key.corners);
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
    static const auto triangle_facets = facets_of(PrimitiveKind::triangle);
    static const auto cube_facets = facets_of(PrimitiveKind::cube);
    const bool solid = kind == PrimitiveKind::cube;
    const TessellatedPrimitive& shape = tessellated(kind, 0);
    std::array<std::uint32_t, most_flat_vertices> index;
    GRAFTAL_CHECK(shape.vertices.size() <= index.size(), name_of(kind));
    for (std::size_t i = 0; i < shape.vertices.size(); ++i)
        index[i] = welded(body_from_leaf(shape.vertices[i]));
    for (const auto& corners : solid ? cube_facets : triangle_facets) {
        Facet facet{
            {Facet::no_corner, Facet::no_corner, Facet::no_corner, Facet::no_corner}, solid, false, leaf};
        for (std::size_t i = 0; i < corners.size(); ++i)
            facet.corners[mirrored ? (corners.size() - i) % corners.size() : i] = index[corners[i]];
        add_unless_hidden(facet);
    }
}

std::uint32_t MeshBuilder::welded(Vec3 point) {
    GridPoint cell;
    for (int k = 0; k < 3; ++k)
        cell.cell[k] = static_cast<std::int64_t>(std::floor(point[k] / weld_unit + 0.5));
    const auto [place, added] = vertex_at_.emplace(cell, static_cast<std::uint32_t>(vertices_.size()));
    if (added) vertices_.push_back(point);
    return place->second;
}

void MeshBuilder::add_unless_hidden(const Facet& facet) {
    FacetKey key{facet.corners};
    std::sort(key.corners.begin(), key.corners.end());
    if (std::adjacent_find(key.corners.begin(), key.corners.begin() + 3) != key.corners.begin() + 3)
        return; // too thin to have an inside
    const std::size_t triangles = facet.corners[3] == Facet::no_corner ? 1 : 2;
    const auto [place, added] = facet_at_.emplace(key, static_cast<std::uint32_t>(facets_.size()));
    if (added) {
        facets_.push_back(facet);
        triangle_count_ += triangles;
        return;
    }
    Facet& other = facets_[place->second];
    const bool back_to_back = turns_to_smaller(facet.corners) != turns_to_smaller(other.corners);
    if (facet.solid && other.solid && back_to_back && !other.hidden) {
        other.hidden = true;
        triangle_count_ -= triangles;
    }
}

void MeshBuilder::push(const std::array<std::uint32_t, 3>& corners, std::size_t leaf) {
    mesh.triangles.push_back(corners);
    leaf_of_triangle.push_back(leaf);
    if (smooth_) ++triangle_count_;
}

void MeshBuilder::finish() {
    if (smooth_) return;
    used_.assign(vertices_.size(), UINT32_MAX);
    mesh.triangles.reserve(triangle_count_);
    leaf_of_triangle.reserve(triangle_count_);
    for (const Facet& facet : facets_) {
        if (facet.hidden) continue;
        std::array<std::uint32_t, 4> c = facet.corners;
        for (std::uint32_t& corner : c)
            if (corner != Facet::no_corner) corner = used(corner);
        push({c[0], c[1], c[2]}, facet.leaf);
        if (c[3] != Facet::no_corner) push({c[0], c[2], c[3]}, facet.leaf);
    }
}

std::uint32_t MeshBuilder::used(std::uint32_t vertex) {
    if (used_[vertex] == UINT32_MAX) {
        used_[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(vertices_[vertex]);
    }
    return used_[vertex];
}

} // namespace graftal
