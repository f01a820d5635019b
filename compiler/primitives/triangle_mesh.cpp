#include "compiler/primitives/triangle_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/primitives/symmetry_maps.h"
#include "compiler/support/id_table.h"

namespace graftal {

namespace {

/// A triangle has no area when its height is less than this share of its longest side.
constexpr double least_height = 1e-12;

std::vector<Triangle> triangles_of(const MeshData& data) {
    std::vector<Triangle> triangles;
    triangles.reserve(data.triangles.size());
    for (const auto& [a, b, c] : data.triangles)
        triangles.push_back({data.vertices[a], data.vertices[b], data.vertices[c]});
    return triangles;
}

bool has_area(const Triangle& t) {
    const double longest =
        std::max({glm::distance(t[0], t[1]), glm::distance(t[1], t[2]), glm::distance(t[2], t[0])});
    return glm::length(area_normal(t)) > least_height * longest * longest;
}

/// The triangle turned about so that its least corner is the first.
Triangle from_least_corner(Triangle t) {
    const auto less = [](Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::rotate(t.begin(), std::ranges::min_element(t, less), t.end());
    return t;
}

/// Equal for equal corners: 0 and -0 are equal.
std::uint64_t hash_of(const Triangle& triangle) {
    std::uint64_t hash = 0;
    for (const Vec3& corner : triangle)
        for (int i = 0; i < 3; ++i)
            hash = mixed(hash, std::bit_cast<std::uint64_t>(corner[i] + 0.0));
    return hash;
}

const TriangleMesh& form_of(const Primitive& primitive) {
    return shape_of<TriangleMesh>(primitive);
}

/// The weights of the corners at a point of the triangle's plane (barycentric coordinates).
std::array<double, 3> shares_of(const Triangle& t, Vec3 point) {
    const Vec3 normal = area_normal(t);
    const double whole = glm::dot(normal, normal);
    const double b = glm::dot(glm::cross(point - t[0], t[2] - t[0]), normal) / whole;
    const double c = glm::dot(glm::cross(t[1] - t[0], point - t[0]), normal) / whole;
    return {1 - b - c, b, c};
}

Vec3 normal_at(const TriangleMesh& form, std::uint32_t number, const std::array<double, 3>& share) {
    const Vec3 facet = glm::normalize(area_normal(form.tree.triangles()[number]));
    if (form.data.normals.empty()) return facet;
    Vec3 sum(0.0);
    for (std::size_t k = 0; k < 3; ++k)
        sum += share[k] * form.data.normals[form.data.triangles[number][k]];
    const double length = glm::length(sum);
    return length > 0 ? sum / length : facet;
}

/// The triangle whose coordinates a point of the surface has; any where there are none.
std::uint32_t triangle_at(const TriangleMesh& form, Vec3 point) {
    return form.data.uv.empty() ? 0 : form.tree.nearest(point);
}

/// The file's coordinates where it has them, else the picture over the box, seen from the front.
TexturePoint texture_at(const TriangleMesh& form, std::uint32_t number, Vec3 point) {
    if (form.data.uv.empty()) {
        const Vec3 size = form.box.size();
        return {size.x > 0 ? (point.x - form.box.min.x) / size.x : 0,
                size.y > 0 ? (point.y - form.box.min.y) / size.y : 0};
    }
    const auto& uv = form.data.uv[number];
    const std::array<double, 3> share = shares_of(form.tree.triangles()[number], point);
    TexturePoint result;
    for (std::size_t k = 0; k < 2; ++k)
        result[k] = share[0] * uv[0][k] + share[1] * uv[1][k] + share[2] * uv[2][k];
    return result;
}

} // namespace

TriangleMesh::TriangleMesh(std::string name, MeshData mesh)
    : Shape(std::move(name)), data(std::move(mesh)), tree(triangles_of(data)), box(box_about(data.vertices)) {
    for (const Triangle& triangle : tree.triangles())
        areas.add(0.5 * glm::length(area_normal(triangle)));
}

MeshData without_slivers(const MeshData& data, bool keeps_repeats) {
    MeshData kept;
    constexpr std::uint32_t unknown = UINT32_MAX;
    std::vector<std::uint32_t> number(data.vertices.size(), unknown);
    IdTable places;
    for (std::size_t i = 0; i < data.triangles.size(); ++i) {
        const auto& [a, b, c] = data.triangles[i];
        const Triangle triangle{data.vertices[a], data.vertices[b], data.vertices[c]};
        if (!has_area(triangle)) continue;
        const auto next = static_cast<std::uint32_t>(kept.triangles.size());
        const Triangle place = from_least_corner(triangle);
        const auto is_there = [&](std::uint32_t other) {
            const auto& [d, e, f] = kept.triangles[other];
            return from_least_corner({kept.vertices[d], kept.vertices[e], kept.vertices[f]}) == place;
        };
        if (!keeps_repeats && places.find_or_add(hash_of(place), next, is_there) != next) continue;
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t old = data.triangles[i][k];
            if (number[old] == unknown) {
                number[old] = static_cast<std::uint32_t>(kept.vertices.size());
                kept.vertices.push_back(triangle[k]);
                if (!data.normals.empty()) {
                    const double length = glm::length(data.normals[old]);
                    kept.normals.push_back(length > 0 ? data.normals[old] / length
                                                      : glm::normalize(area_normal(triangle)));
                }
            }
            corners[k] = number[old];
        }
        kept.triangles.push_back(corners);
        if (!data.uv.empty()) kept.uv.push_back(data.uv[i]);
    }
    return kept;
}

namespace triangle_mesh {

Box box(const Primitive& primitive) {
    return form_of(primitive).box;
}

Ball ball(const Primitive& primitive) {
    return ball_about(form_of(primitive).data.vertices);
}

Vec3 support_point(const Primitive& primitive, Vec3 direction) {
    return form_of(primitive).tree.farthest(direction);
}

double reach(const Primitive& primitive, Vec3 direction) {
    return form_of(primitive).tree.reach(direction);
}

std::vector<HullPiece> hull(const Primitive& primitive) {
    std::vector<HullPiece> pieces;
    for (const Vec3& corner : form_of(primitive).box.corners())
        pieces.push_back({HullPiece::Kind::point, Affine::translate(corner)});
    return pieces;
}

/// Hulls of parts that lie together, each by its farthest corners in many directions.
std::vector<ConvexPart> convex_parts(const Primitive& primitive) {
    constexpr std::size_t most_parts = 64;
    const TriangleTree& tree = form_of(primitive).tree;
    std::vector<ConvexPart> parts;
    for (const std::vector<std::uint32_t>& numbers : tree.parts(most_parts)) {
        std::vector<Vec3> points;
        for (const std::uint32_t number : numbers)
            points.insert(points.end(), tree.triangles()[number].begin(), tree.triangles()[number].end());
        ConvexPart part;
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (x != 0 || y != 0 || z != 0)
                        part.corners.push_back(farthest_of(points, Vec3(x, y, z)));
        parts.push_back(std::move(part));
    }
    return parts;
}

double inner_radius(const Primitive& primitive) {
    const Vec3 size = form_of(primitive).box.size();
    const double largest = std::max({size.x, size.y, size.z});
    return 0.25 * std::max(std::min({size.x, size.y, size.z}), 1e-2 * largest);
}

/// Nothing but the identity: symmetries of meshes are not looked for.
bool keeps(const Primitive&, const Affine& map) {
    return glm::length(map.translation) < symmetry_tolerance && is_near_zero(map.linear - Mat3(1.0), 1);
}

TessellatedPrimitive mesh(const Primitive& primitive, int) {
    const MeshData& data = form_of(primitive).data;
    return {.vertices = data.vertices, .normals = data.normals, .triangles = data.triangles};
}

TexturePoint texture_point(const Primitive& primitive, const TextureSpace&, Vec3 point) {
    const TriangleMesh& form = form_of(primitive);
    return texture_at(form, triangle_at(form, point), point);
}

/// On the corners of a seam two triangles have their own coordinates each.
std::array<TexturePoint, 3> texture_triangle(const Primitive& primitive, const TextureSpace&,
                                             const std::array<Vec3, 3>& points) {
    const TriangleMesh& form = form_of(primitive);
    const std::uint32_t number = triangle_at(form, (points[0] + points[1] + points[2]) / 3.0);
    return {texture_at(form, number, points[0]), texture_at(form, number, points[1]),
            texture_at(form, number, points[2])};
}

double area(const Primitive& primitive) {
    return form_of(primitive).areas.whole();
}

SurfaceSite site(const Primitive& primitive, Vec3 u) {
    const TriangleMesh& form = form_of(primitive);
    const auto number = static_cast<std::uint32_t>(form.areas.piece(u.z));
    const Triangle& triangle = form.tree.triangles()[number];
    const Vec3 point = point_of(triangle, u.x, u.y);
    return {point, normal_at(form, number, shares_of(triangle, point))};
}

bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    return intersect_within(primitive, ray, range, hit, UINT64_MAX);
}

bool intersect_within(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit,
                      std::uint64_t most_steps) {
    const TriangleMesh& form = form_of(primitive);
    TriangleHit met;
    std::uint32_t number = 0;
    hit.steps = 0;
    if (!form.tree.meet(ray, range, met, number, hit.steps, most_steps)) return false;
    hit.t = met.t;
    hit.normal = normal_at(form, number, met.share);
    hit.facet_side = glm::dot(area_normal(form.tree.triangles()[number]), ray.direction) > 0 ? 1 : -1;
    return true;
}

} // namespace triangle_mesh

} // namespace graftal
