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

/// Reads a mesh: OBJ (vertices, normals, texture coordinates, faces of any number of corners, cut into fans),
/// PLY or STL (ascii or binary; their bytes say which). Leaves out triangles without an area, and those that
/// come again. Nothing, and what is at fault, for what is none of these, is damaged, or has too much or
/// nothing in it: counts in a file are held against the limits and its length before anything is made room
/// for.
std::optional<MeshData> read_mesh(std::string_view bytes, std::string& fault);

/// Reads a mesh whose triangles and normals are all as the file has them, or a cloud of points: a file
/// without faces.
std::optional<MeshData> read_mesh_or_cloud(std::string_view bytes, std::string& fault);

/// The fault of a coordinate, of a vertex or of a picture; empty if there is none.
std::string fault_of_coordinate(double coordinate);

/// Whether a file of this name promises a mesh, by its ending.
bool is_mesh_name(std::string_view file_name);

/// The parts of read_mesh(). A fault begins with its line, or in a PLY's body and in binary parts with its
/// byte.
std::optional<MeshData> read_obj(std::string_view text, std::string& fault);
std::optional<MeshData> read_ply(std::string_view bytes, std::string& fault);
std::optional<MeshData> read_stl(std::string_view bytes, std::string& fault);

/// The length of a binary STL file with the number of facets that these bytes give; of one without facets if
/// they give none. A file of just this length is such a file: it may begin with anything, even "solid".
std::uint64_t binary_stl_size(std::string_view bytes);
bool is_binary_stl(std::string_view bytes);

/// The primitive of the mesh in the file of this name. Requires what read_mesh() gives.
Primitive mesh_primitive(std::string_view path, MeshData data);

} // namespace graftal
