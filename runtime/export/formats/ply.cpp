// PLY, binary: every triangle, colours by vertex.

#include "runtime/export/formats/flat_files.h"

namespace graftal {

namespace {

constexpr std::uint64_t ply_vertex_bytes = 27, ply_uv_bytes = 8, ply_triangle_bytes = 13;

Status write_ply_mesh(const ExportJob& job, ExportReport& report) {
    const bool pictures = has_pictures(job.scene);
    const std::uint64_t vertex_bytes = ply_vertex_bytes + (pictures ? ply_uv_bytes : 0);
    const auto bytes = [&](const SceneShape& shape) {
        const MeshSize size = mesh_size(shape, pictures);
        return size.vertices * vertex_bytes + size.triangles * ply_triangle_bytes;
    };
    if (refuse_range(job, 1) || refuse_size(job, bytes)) return {};
    // The head states numbers that the walk finds: no sum over shapes knows how many corners
    // the seams of pictures divide.
    ShapeMeshes meshes(job.scene);
    std::uint64_t vertices = 0, triangles = 0;
    OutputFile file(job.options.output, job.options.most_bytes, job.too_large);
    if (!file.ok()) return file.status();
    Status status = for_each_leaf(job, file, [&](const SceneLeaf& leaf) {
        const ShapeMesh& mesh = meshes.of(leaf.shape, leaf.look);
        vertices += mesh.vertices.size();
        triangles += mesh.triangles.size();
    });
    if (!status.ok()) return status;
    file.text("ply\nformat binary_little_endian 1.0\n");
    for (const std::string& line : comment_lines(job.options.metadata))
        file.print("comment {}\n", line);
    file.print("element vertex {}\n", vertices);
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
        file.print("property float {}\n", name);
    for (const char* name : {"red", "green", "blue"})
        file.print("property uchar {}\n", name);
    if (pictures) file.text("property float s\nproperty float t\n");
    file.print("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", triangles);
    status = for_each_leaf(job, file, [&](const SceneLeaf& leaf) {
        const ShapeMesh& mesh = meshes.of(leaf.shape, leaf.look);
        const PlacedShape placed(mesh, leaf.world_from_shape);
        const std::array<std::uint8_t, 3> rgb = srgb_bytes(leaf.look.colour());
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            for (const Vec3& v : {placed.vertex(i), placed.normal(i)})
                for (int axis = 0; axis < 3; ++axis)
                    file.number(static_cast<float>(v[axis]));
            for (const std::uint8_t level : rgb)
                file.byte(level);
            if (!pictures) continue;
            const std::array<double, 2> uv = mesh.uv.empty() ? std::array{0.0, 0.0} : mesh.uv[i];
            file.number(static_cast<float>(uv[0]));
            file.number(static_cast<float>(uv[1]));
        }
        file.text({});
    });
    std::uint32_t first = 0;
    if (status.ok())
        status = for_each_leaf(job, file, [&](const SceneLeaf& leaf) {
            const ShapeMesh& mesh = meshes.of(leaf.shape, leaf.look);
            const PlacedShape placed(mesh, leaf.world_from_shape);
            for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
                file.byte(3);
                for (const std::uint32_t corner : placed.triangle(i))
                    file.number(first + corner);
            }
            first += static_cast<std::uint32_t>(mesh.vertices.size());
            file.text({});
        });
    if (status.ok()) status = file.close();
    if (!status.ok()) return status;
    report.summary = fmt::format("{} triangles", triangles);
    return file.pending().commit();
}

} // namespace

const ExportFormat ply_format = {
    .extension = ".ply",
    .name = "PLY (binary)",
    .summary = "every triangle, with normals, colours and places on pictures by vertex",
    .meshes = SceneMeshes::by_size,
    .write = write_ply_mesh,
};

} // namespace graftal
