#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/primitives/mesh_file.h"
#include "compiler/primitives/triangle_mesh.h"

namespace graftal {

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
    for (Vec3& normal : data->normals) {
        const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
        // What is no number, and what has no direction, is as if the file had none there.
        normal = largest > 0 && std::isfinite(largest) ? normal / largest : Vec3(0.0);
    }
    MeshData kept = without_slivers(*data);
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

constinit const PrimitiveTraits mesh_traits = triangle_mesh::traits();

} // namespace graftal
