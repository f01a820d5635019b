#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/primitives/mesh_file.h"
#include "compiler/primitives/shape_parts.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/primitives/triangle_tree.h"

namespace graftal {
namespace {

std::vector<Triangle> triangles_of(const MeshData& data) {
    std::vector<Triangle> triangles;
    triangles.reserve(data.triangles.size());
    for (const auto& [a, b, c] : data.triangles)
        triangles.push_back({data.vertices[a], data.vertices[b], data.vertices[c]});
    return triangles;
}

class TriangleMesh : public Shape {
  public:
    TriangleMesh(std::string name, MeshData read)
        : Shape(std::move(name)), data(std::move(read)), tree(triangles_of(data)),
          box(box_about(data.vertices)) {
        for (const Triangle& triangle : tree.triangles())
            areas.add(0.5 * glm::length(area_normal(triangle)));
    }

    MeshData data;
    TriangleTree tree;
    Box box;
    AreaSampler areas;
};

const TriangleMesh& form_of(const Primitive& primitive) {
    return shape_of<TriangleMesh>(primitive);
}

Box box(const Primitive& primitive) {
    return form_of(primitive).box;
}

Ball ball(const Primitive& primitive) {
    return ball_about(form_of(primitive).data.vertices);
}

Vec3 support_point(const Primitive& primitive, Vec3 direction) {
    return form_of(primitive).tree.farthest(direction);
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

Vec3 fixed_point(const Primitive& primitive) {
    return form_of(primitive).box.centre();
}

/// Nothing but the identity: symmetries of meshes are not looked for.
bool keeps(const Primitive&, const Affine& map) {
    return glm::length(map.translation) < symmetry_tolerance && is_near_zero(map.linear - Mat3(1.0), 1);
}

TessellatedPrimitive mesh(const Primitive& primitive, int) {
    const MeshData& data = form_of(primitive).data;
    return {.vertices = data.vertices, .normals = {}, .triangles = data.triangles};
}

double mesh_error(const Primitive&, int) {
    return 0;
}

std::vector<FacetCorners> facets(const Primitive& primitive) {
    std::vector<FacetCorners> facets;
    for (const auto& [a, b, c] : form_of(primitive).data.triangles)
        facets.push_back({a, b, c, no_facet_corner});
    return facets;
}

/// The file's coordinates where it has them, else the picture over the box, seen from the front.
TexturePoint texture_at(const TriangleMesh& form, std::uint32_t number, Vec3 point) {
    if (form.data.uv.empty()) {
        const Vec3 size = form.box.size();
        return {size.x > 0 ? (point.x - form.box.min.x) / size.x : 0,
                size.y > 0 ? (point.y - form.box.min.y) / size.y : 0};
    }
    const Triangle& t = form.tree.triangles()[number];
    const auto& uv = form.data.uv[number];
    const Vec3 normal = area_normal(t);
    const double whole = glm::dot(normal, normal);
    const double b = glm::dot(glm::cross(point - t[0], t[2] - t[0]), normal) / whole;
    const double c = glm::dot(glm::cross(t[1] - t[0], point - t[0]), normal) / whole;
    TexturePoint result;
    for (std::size_t k = 0; k < 2; ++k)
        result[k] = (1 - b - c) * uv[0][k] + b * uv[1][k] + c * uv[2][k];
    return result;
}

TexturePoint texture_point(const Primitive& primitive, const TextureSpace&, Vec3 point) {
    const TriangleMesh& form = form_of(primitive);
    return texture_at(form, form.tree.nearest(point), point);
}

/// On the corners of a seam two triangles have their own coordinates each.
std::array<TexturePoint, 3> texture_triangle(const Primitive& primitive, const std::array<Vec3, 3>& points) {
    const TriangleMesh& form = form_of(primitive);
    const std::uint32_t number = form.tree.nearest((points[0] + points[1] + points[2]) / 3.0);
    return {texture_at(form, number, points[0]), texture_at(form, number, points[1]),
            texture_at(form, number, points[2])};
}

double area(const Primitive& primitive) {
    return form_of(primitive).areas.whole();
}

SurfaceSite site(const Primitive& primitive, Vec3 u) {
    const TriangleMesh& form = form_of(primitive);
    const Triangle& triangle = form.tree.triangles()[form.areas.piece(u.z)];
    return {point_of(triangle, u.x, u.y), glm::normalize(area_normal(triangle))};
}

bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    const TriangleTree& tree = form_of(primitive).tree;
    std::uint32_t number = 0;
    if (!tree.meet(ray, range, hit.t, number)) return false;
    hit.normal = glm::normalize(area_normal(tree.triangles()[number]));
    return true;
}

} // namespace

std::optional<MeshData> read_mesh(std::string_view bytes, std::string& fault) {
    std::optional<MeshData> data = bytes.starts_with("ply\n") || bytes.starts_with("ply\r")
                                       ? read_ply(bytes, fault)
                                       : read_obj(bytes, fault);
    if (!data) return std::nullopt;
    for (const Vec3& v : data->vertices)
        for (int i = 0; i < 3; ++i)
            if (!(std::abs(v[i]) <= most_mesh_coordinate)) {
                fault = fmt::format("a coordinate is {}, and {} is the most", v[i], most_mesh_coordinate);
                return std::nullopt;
            }
    for (const auto& corners : data->uv)
        for (const auto& uv : corners)
            if (!(std::abs(uv[0]) <= most_mesh_coordinate && std::abs(uv[1]) <= most_mesh_coordinate)) {
                fault = "a texture coordinate is no number, or too large";
                return std::nullopt;
            }
    MeshData kept;
    std::vector<std::uint32_t> number(data->vertices.size(), UINT32_MAX);
    for (std::size_t i = 0; i < data->triangles.size(); ++i) {
        const auto& [a, b, c] = data->triangles[i];
        const Triangle triangle{data->vertices[a], data->vertices[b], data->vertices[c]};
        const double longest =
            std::max({glm::distance(triangle[0], triangle[1]), glm::distance(triangle[1], triangle[2]),
                      glm::distance(triangle[2], triangle[0])});
        if (!(glm::length(area_normal(triangle)) > 1e-12 * longest * longest)) continue;
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& known = number[data->triangles[i][k]];
            if (known == UINT32_MAX) {
                known = static_cast<std::uint32_t>(kept.vertices.size());
                kept.vertices.push_back(triangle[k]);
            }
            corners[k] = known;
        }
        kept.triangles.push_back(corners);
        if (!data->uv.empty()) kept.uv.push_back(data->uv[i]);
    }
    if (kept.triangles.empty()) {
        fault = "no triangle of the file has an area";
        return std::nullopt;
    }
    return kept;
}

Primitive mesh_primitive(std::string_view path, MeshData data) {
    return Primitive(PrimitiveKind::mesh, std::make_shared<const TriangleMesh>(
                                              fmt::format("mesh(\"{}\")", path), std::move(data)));
}

constinit const PrimitiveTraits mesh_traits = {
    .box = box,
    .ball = ball,
    .support_point = support_point,
    .hull = hull,
    .convex_parts = convex_parts,
    .inner_radius = inner_radius,
    .fixed_point = fixed_point,
    .keeps = keeps,
    .mesh = mesh,
    .mesh_error = mesh_error,
    .facets = facets,
    .texture_point = texture_point,
    .texture_triangle = texture_triangle,
    .area = area,
    .site = site,
    .intersect = intersect,
};

} // namespace graftal
