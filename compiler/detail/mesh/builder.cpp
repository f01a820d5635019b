#include "compiler/detail/mesh/builder.h"

#include <array>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/primitives/primitive_cache.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/support/check.h"
#include "compiler/support/normal_map.h"

namespace graftal {

namespace {

/// Facets that are compared with each other before they are compared with all.
constexpr std::size_t most_latest_facets = 16384;

/// The facets of a flat primitive, and the same seen in a mirror.
using FacetSides = std::array<std::vector<FacetCorners>, 2>;

const FacetSides& facet_sides(const Primitive& primitive) {
    static PrimitiveCache<FacetSides> sides;
    return sides.get(primitive, [&] {
        FacetSides both;
        both[0] = both[1] = traits_of(primitive).facets(primitive);
        for (FacetCorners& c : both[1])
            std::swap(c[1], c[c[3] == no_facet_corner ? 2 : 3]);
        return both;
    });
}

/// The direction of a sum, of unit length, where it has one.
Vec3 unit_or(Vec3 sum, Vec3 otherwise) {
    const double length = glm::length(sum);
    return length > 1e-6 ? sum / length : otherwise;
}

} // namespace

void MeshBuilder::add(const Primitive& primitive, int fineness, const Affine& body_from_leaf,
                      std::uint32_t leaf, const NormalField& normals) {
    const bool mirrored = glm::determinant(body_from_leaf.linear) < 0;
    const bool curved = !tessellated(primitive, fineness).normals.empty();
    GRAFTAL_CHECK(smooth_ || !curved, "curved primitive in a flat mesh");
    if (curved)
        add_smooth(primitive, fineness, body_from_leaf, leaf, normals);
    else if (smooth_)
        add_facets(primitive, body_from_leaf, mirrored, leaf);
    else
        add_flat(primitive, body_from_leaf, mirrored, leaf);
}

/// Asked of a triangle by its corners, counter-clockwise seen from outside unless the map has mirrored them.
bool MeshBuilder::leaves_out(Vec3 a, Vec3 b, Vec3 c, bool mirrored) const {
    if (left_out_ == Vec3(0.0)) return false;
    constexpr double edge_on = 1e-6; // a rim stays
    const Vec3 normal = glm::cross(b - a, c - a);
    const double along = mirrored ? -glm::dot(normal, left_out_) : glm::dot(normal, left_out_);
    return along > edge_on * glm::length(normal) * glm::length(left_out_);
}

void MeshBuilder::add_smooth(const Primitive& primitive, int fineness, const Affine& body_from_leaf,
                             std::uint32_t leaf, const NormalField& normals) {
    const TessellatedPrimitive& shape = tessellated(primitive, fineness);
    const Mat3 normal_by_normal = normal_map(body_from_leaf.linear);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
        mesh.vertices.push_back(body_from_leaf(shape.vertices[i]));
        const Vec3 own = glm::normalize(normal_by_normal * shape.normals[i]);
        mesh.normals.push_back(unit_or(own + normals.at(mesh.vertices.back()), own));
    }
    const bool mirrored = glm::determinant(body_from_leaf.linear) < 0;
    for (const auto& t : shape.triangles)
        if (!leaves_out(mesh.vertices[first + t[0]], mesh.vertices[first + t[1]], mesh.vertices[first + t[2]],
                        mirrored))
            push({first + t[0], first + t[1], first + t[2]}, leaf);
}

void MeshBuilder::add_textured(const Primitive& primitive, int fineness, const Affine& body_from_leaf,
                               const TextureSpace& space, std::uint32_t leaf) {
    GRAFTAL_CHECK(smooth_, "texture in a flat mesh");
    const TessellatedPrimitive& shape = tessellated(primitive, fineness);
    const Mat3 normal_by_normal = normal_map(body_from_leaf.linear);
    const bool mirrored = glm::determinant(body_from_leaf.linear) < 0;
    for (const auto& triangle : shape.triangles) {
        std::array<Vec3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k)
            corner[k] = shape.vertices[triangle[k]];
        if (leaves_out(body_from_leaf(corner[0]), body_from_leaf(corner[1]), body_from_leaf(corner[2]),
                       mirrored))
            continue;
        for (const auto& uv : texture_coordinates(primitive, space, corner))
            mesh.uv.push_back(uv);
        const Vec3 facet = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 normal = shape.normals.empty() ? facet : shape.normals[triangle[k]];
            mesh.vertices.push_back(body_from_leaf(corner[k]));
            mesh.normals.push_back(glm::normalize(normal_by_normal * normal));
        }
        push({first, first + 1, first + 2}, leaf);
    }
}

void MeshBuilder::add_facets(const Primitive& primitive, const Affine& body_from_leaf, bool mirrored,
                             std::uint32_t leaf) {
    const TessellatedPrimitive& shape = tessellated(primitive, 0);
    for (const auto& triangle : shape.triangles) {
        std::array<Vec3, 3> corner;
        for (int k = 0; k < 3; ++k)
            corner[k] = body_from_leaf(shape.vertices[triangle[k]]);
        const Vec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        const double length = glm::length(normal);
        if (!(length > 0) || leaves_out(corner[0], corner[1], corner[2], mirrored)) continue;
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const Vec3& point : corner) {
            mesh.vertices.push_back(point);
            mesh.normals.push_back((mirrored ? -normal : normal) / length);
        }
        push({first, first + 1, first + 2}, leaf);
    }
}

void MeshBuilder::add_flat(const Primitive& primitive, const Affine& body_from_leaf, bool mirrored,
                           std::uint32_t leaf) {
    const TessellatedPrimitive& shape = tessellated(primitive, 0);
    index_.clear();
    for (const Vec3& vertex : shape.vertices)
        index_.push_back(latest_.vertex(body_from_leaf(vertex)));
    for (const FacetCorners& c : facet_sides(primitive)[mirrored]) {
        const auto corner = [&](std::size_t k) { return body_from_leaf(shape.vertices[c[k]]); };
        if (leaves_out(corner(0), corner(1), corner(2), false)) continue;
        latest_.add({.corners = {index_[c[0]], index_[c[1]], index_[c[2]],
                                 c[3] == no_facet_corner ? Facet::no_corner : index_[c[3]]},
                     .leaf = leaf,
                     .solid = traits_of(primitive).solid});
    }
    if (latest_.facets().size() > most_latest_facets) latest_.move_to(all_);
}

std::size_t MeshBuilder::triangle_count() const {
    return mesh.triangles.size() + latest_.triangle_count() + all_.triangle_count();
}

void MeshBuilder::push(const std::array<std::uint32_t, 3>& corners, std::uint32_t leaf) {
    mesh.triangles.push_back(corners);
    leaf_of_triangle.push_back(leaf);
}

void MeshBuilder::finish() {
    if (smooth_) return;
    latest_.move_to(all_);
    used_.assign(all_.vertices().size(), UINT32_MAX);
    mesh.triangles.reserve(all_.triangle_count());
    leaf_of_triangle.reserve(all_.triangle_count());
    for (const Facet& facet : all_.facets()) {
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
        mesh.vertices.push_back(all_.vertices()[vertex]);
    }
    return used_[vertex];
}

} // namespace graftal
