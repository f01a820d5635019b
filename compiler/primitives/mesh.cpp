#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/primitives/mesh_file.h"
#include "compiler/primitives/triangle_mesh.h"
#include "compiler/support/path_text.h"
#include "compiler/support/small_letters.h"

namespace graftal {

std::string fault_of_coordinate(double coordinate) {
    if (std::abs(coordinate) <= most_mesh_coordinate) return {};
    return fmt::format("a coordinate is {}, and {} is the most", coordinate, most_mesh_coordinate);
}

bool is_mesh_name(std::string_view file_name) {
    const std::string ending = in_small_letters(extension_of(file_name));
    return ending == ".obj" || ending == ".ply" || ending == ".stl";
}

std::optional<MeshData> read_mesh_or_cloud(std::string_view bytes, std::string& fault) {
    const bool is_ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
    const bool is_binary = is_ply || is_binary_stl(bytes);
    if (const std::size_t zero = bytes.find('\0'); !is_binary && zero != std::string_view::npos) {
        fault = fmt::format("it is no OBJ, PLY or STL mesh: byte {} is zero, as no text has it, and a binary "
                            "STL file of its number of triangles has {} bytes, not {}",
                            zero + 1, binary_stl_size(bytes), bytes.size());
        return std::nullopt;
    }
    const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    const bool is_stl = is_binary || in_small_letters(bytes.substr(begin, 5)) == "solid";
    return is_ply ? read_ply(bytes, fault) : is_stl ? read_stl(bytes, fault) : read_obj(bytes, fault);
}

std::optional<MeshData> read_mesh(std::string_view bytes, std::string& fault) {
    std::optional<MeshData> data = read_mesh_or_cloud(bytes, fault);
    if (!data) return std::nullopt;
    if (data->triangles.empty()) {
        fault = data->vertices.empty()
                    ? "it holds no vertex ('v' in an OBJ file, 'element vertex' in a PLY file, 'vertex' in "
                      "an STL file)"
                    : "it holds no face, so there is nothing to draw";
        return std::nullopt;
    }
    for (Vec3& normal : data->normals) {
        const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
        // A normal that is no number, or has no direction, counts as if the file had none there.
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
