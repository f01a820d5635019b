#include "runtime/export/formats/flat_files.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/support/printable.h"

namespace graftal {

namespace {

/// Largest coordinate and least extent: readers hold the squares of both in 32-bit floats.
constexpr double most_coordinate = 1e18, least_extent = 1e-18;
constexpr std::uint64_t leaves_a_look = 4096;

} // namespace

MeshSize mesh_size(const SceneShape& shape, bool pictured) {
    const TessellatedPrimitive& mesh = tessellated(shape.primitive, shape.fineness);
    const std::uint64_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
    if (pictured) return {std::min(vertices, 3 * triangles), triangles};
    return {mesh.normals.empty() ? 3 * triangles : vertices, triangles};
}

bool has_pictures(const UnfoldedScene& scene) {
    return std::ranges::any_of(scene.materials,
                               [](const Material& material) { return !material.texture.empty(); });
}

bool refuse_size(const ExportJob& job, const std::function<std::uint64_t(const SceneShape&)>& bytes) {
    const BigCount size = sum_over_leaves(job.scene, bytes);
    const bool pictured = has_pictures(job.scene);
    const BigCount vertices = sum_over_leaves(job.scene, [&](const SceneShape& shape) {
        const MeshSize mesh = mesh_size(shape, pictured);
        return pictured ? 3 * mesh.triangles : mesh.vertices;
    });
    if (size <= job.options.most_bytes && vertices < UINT32_MAX) return false;
    const BigCount leaves = sum_over_leaves(job.scene, [](const SceneShape&) { return 1; });
    const BigCount triangles =
        sum_over_leaves(job.scene, [](const SceneShape& shape) { return mesh_size(shape, false).triangles; });
    const std::string large =
        size < BigCount(1) << 60 ? readable_bytes(size.convert_to<double>()) : in_words(size) + " bytes";
    refuse_as_too_large(
        job,
        fmt::format("'{}' would have {} primitives with {} triangles, {}", job.options.output,
                    in_words(leaves), in_words(triangles), large),
        fmt::format("{}leave out more with a larger --error or fewer --steps, or choose a format "
                    "that shares parts, such as .usda",
                    vertices < UINT32_MAX ? "allow it with --limit, " : ""));
    return true;
}

bool refuse_range(const ExportJob& job, double unit) {
    const Box& box = job.scene.bounds;
    if (box.empty()) return false;
    const double farthest = unit * std::max(largest_entry(box.min), largest_entry(box.max));
    const double extent = unit * largest_entry(box.size());
    if (farthest <= most_coordinate && (extent >= least_extent || extent == 0)) return false;
    job.diagnostics
        .error(job.model,
               fmt::format("the model reaches {:.3g} units far and measures {:.3g}: the numbers of "
                           "'{}' do not hold that",
                           farthest, extent, job.options.output))
        .with_hint("scale the model to a size between 1e-18 and 1e18");
    return true;
}

Status for_each_leaf(const ExportJob& job, OutputFile& file,
                     const std::function<void(const SceneLeaf&)>& add) {
    std::uint64_t leaves = 0;
    const bool whole = walk_leaves(job.scene, job.scene.root, {}, {}, [&](const SceneLeaf& leaf) {
        if (leaves++ % leaves_a_look == 0 && job.cancel.raised()) return false;
        add(leaf);
        return file.ok();
    });
    if (!file.ok()) return file.status();
    return whole ? Status() : Status::failure("interrupted");
}

std::array<std::uint8_t, 3> srgb_bytes(Rgb linear) {
    std::array<std::uint8_t, 3> bytes{};
    for (int i = 0; i < 3; ++i)
        bytes[static_cast<std::size_t>(i)] = level8_of(srgb_encoded(static_cast<float>(linear[i])));
    return bytes;
}

std::vector<std::string> comment_lines(const ImageMetadata& metadata) {
    std::vector<std::string> lines;
    for (const std::string& line : {metadata.software, metadata.description})
        if (!line.empty()) lines.push_back(escaped(line, line.size()));
    return lines;
}

} // namespace graftal
