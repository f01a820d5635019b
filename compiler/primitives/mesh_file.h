#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/primitive.h"
#include "compiler/support/affine.h"

namespace graftal {

/// Triangles of a file.
struct MeshData {
    std::vector<Vec3> vertices;
    /// One a vertex; empty where the facets are flat. A vertex may be there twice, with two normals.
    std::vector<Vec3> normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// u and v of each corner of each triangle; empty where the file has none.
    std::vector<std::array<std::array<double, 2>, 3>> uv;
};

inline constexpr std::size_t most_mesh_triangles = 1'000'000;
inline constexpr std::size_t most_mesh_vertices = 1'000'000;
/// No coordinate is larger.
inline constexpr double most_mesh_coordinate = 1e6;

/// Reads a mesh: OBJ (vertices, normals, texture coordinates, faces of any number of corners, cut into fans)
/// or PLY (ascii or binary; its header says which). Leaves out triangles without an area, and those that
/// come again. Nothing, and what is at fault, for what is neither, is damaged, or has too much or nothing in
/// it: a PLY's counts are held against the limits and the length of the file before anything is made room
/// for.
std::optional<MeshData> read_mesh(std::string_view bytes, std::string& fault);

/// The fault of a coordinate, of a vertex or of a picture; empty if there is none.
std::string fault_of_coordinate(double coordinate);

/// The parts of read_mesh(). A fault begins with its line, or in a PLY's elements with its byte.
std::optional<MeshData> read_obj(std::string_view text, std::string& fault);
std::optional<MeshData> read_ply(std::string_view bytes, std::string& fault);

/// The primitive of the mesh in the file of this name. Requires what read_mesh() gives.
Primitive mesh_primitive(std::string_view path, MeshData data);

} // namespace graftal
