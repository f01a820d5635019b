#include "compiler/primitives/solid.h"

#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/primitives/triangle_mesh.h"

namespace graftal {

namespace {

/// The solid that the triangles of a mesh bound.
struct MeshSolid {
    bool closed = false;
    double volume = 0; ///< below 0 where its normals point inwards
};

struct LessPoint {
    bool operator()(const Vec3& a, const Vec3& b) const {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
};

/// Closed where each side of a triangle has one of the other direction. Vertices count by their places.
MeshSolid solid_of(const TriangleMesh& mesh) {
    std::map<Vec3, std::uint32_t, LessPoint> number;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> excess; // of sides in this direction
    double volume = 0;
    for (const Triangle& triangle : mesh.tree.triangles()) {
        std::array<std::uint32_t, 3> corner{};
        for (std::size_t k = 0; k < 3; ++k)
            corner[k] =
                number.emplace(triangle[k] + 0.0, static_cast<std::uint32_t>(number.size())).first->second;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = corner[k], to = corner[(k + 1) % 3];
            if (from < to)
                ++excess[{from, to}];
            else
                --excess[{to, from}];
        }
        const Vec3 middle = mesh.box.centre();
        volume += glm::dot(triangle[0] - middle, glm::cross(triangle[1] - middle, triangle[2] - middle));
    }
    for (const auto& [side, count] : excess)
        if (count != 0) return {};
    return {volume != 0, volume / 6};
}

const MeshSolid* mesh_solid(const Primitive& primitive) {
    static const char key = 0;
    const auto* const mesh = dynamic_cast<const TriangleMesh*>(primitive.shape().get());
    return mesh ? &mesh->derived<MeshSolid>(&key, [&] { return solid_of(*mesh); }) : nullptr;
}

} // namespace

bool encloses_volume(const Primitive& primitive) {
    if (primitive == PrimitiveKind::triangle || primitive == PrimitiveKind::polygon) return false;
    const MeshSolid* const mesh = mesh_solid(primitive);
    return !mesh || mesh->closed;
}

std::optional<double> volume_of(const Primitive& primitive) {
    if (!encloses_volume(primitive)) return 0;
    if (const MeshSolid* const mesh = mesh_solid(primitive)) return std::abs(mesh->volume);
    const auto volume = traits_of(primitive).volume;
    return volume ? std::optional(volume(primitive)) : std::nullopt;
}

bool leaves_solid(const Primitive& primitive, const Ray& ray, const PrimitiveHit& hit) {
    if (hit.facet_side == 0) return glm::dot(hit.normal, ray.direction) > 0;
    return (hit.facet_side > 0) != (mesh_solid(primitive)->volume < 0);
}

} // namespace graftal
