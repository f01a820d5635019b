#pragma once

// Sizes and leaves for formats that list every triangle of every leaf.

#include "runtime/export/formats.h"
#include "runtime/export/output_file.h"
#include "runtime/export/shape_mesh.h"

namespace graftal {

/// The numbers of a mesh that a file has.
struct MeshSize {
    std::uint64_t vertices = 0, triangles = 0;
};

/// Numbers of a shape's mesh as ShapeMeshes has it. Where it may be `pictured`, it has that many vertices
/// about, and no more than three a triangle: seams divide some, equal corners become one.
MeshSize mesh_size(const SceneShape& shape, bool pictured);

/// Whether some material of the model has a picture, so that triangles on both sides of a seam differ.
bool has_pictures(const UnfoldedScene& scene);

/// Refuses a file of more bytes than allowed, or of more vertices than its numbers count. The error states
/// how large it would be. `bytes`: of a leaf of each shape.
bool refuse_size(const ExportJob& job, const std::function<std::uint64_t(const SceneShape&)>& bytes);

/// Refuses a model whose coordinates 32-bit floats do not hold, in these units, with an error.
bool refuse_range(const ExportJob& job, double unit);

/// Walks all leaves of the scene. "interrupted", or the file's failure.
Status for_each_leaf(const ExportJob& job, OutputFile& file,
                     const std::function<void(const SceneLeaf&)>& add);

/// Linear light as files have it.
std::array<std::uint8_t, 3> srgb_bytes(Rgb linear);

/// "graftal 0.1", and the command, each on one line.
std::vector<std::string> comment_lines(const ImageMetadata& metadata);

} // namespace graftal
