// STL, binary: every triangle, for printers. Lengths are millimetres, and z is up.

#include <glm/geometric.hpp>

#include "compiler/primitives/solid.h"
#include "runtime/export/formats/flat_files.h"

namespace graftal {

namespace {

constexpr std::uint64_t stl_head_bytes = 84, stl_triangle_bytes = 50;

using Corner = std::array<float, 3>;

/// Printers have z up.
Corner printed(Vec3 point, double unit_mm) {
    return {static_cast<float>(unit_mm * point.x), static_cast<float>(-unit_mm * point.z),
            static_cast<float>(unit_mm * point.y)};
}

Vec3 widened_corner(const Corner& corner) {
    return {corner[0], corner[1], corner[2]};
}

/// Skins of limbs are closed by their making: to look at all of their triangles would take long.
bool is_closed(const Primitive& primitive) {
    return primitive == PrimitiveKind::limb_sweep || encloses_volume(primitive);
}

/// Printers want solids: a note where some surfaces are none.
void note_open_surfaces(const ExportJob& job) {
    const BigCount open = sum_over_leaves(
        job.scene, [](const SceneShape& shape) { return is_closed(shape.primitive) ? 0u : 1u; });
    if (open == 0) return;
    const BigCount all = sum_over_leaves(job.scene, [](const SceneShape&) { return 1; });
    job.diagnostics
        .note(job.model,
              fmt::format("{} of {} surfaces are not closed, as those of polygons, so that '{}' has "
                          "open edges, which many printers refuse",
                          in_words(open), in_words(all), job.options.output))
        .with_hint(fmt::format("leave leaves out of the model, or give them a thickness; or choose {}, where "
                               "--part keeps them apart from the wood",
                               endings_with(&ExportFormat::has_parts)));
}

Status write_stl(const ExportJob& job, ExportReport& report) {
    const double unit_mm = job.options.unit_mm.value_or(1);
    if (refuse_range(job, unit_mm) || refuse_size(job, [](const SceneShape& shape) {
            return stl_triangle_bytes * mesh_size(shape, false).triangles;
        }))
        return {};
    OutputFile file(job.options.output, job.options.most_bytes, job.too_large);
    if (!file.ok()) return file.status();
    // Corners that rounding brings together make a triangle nothing: it is left out, and the edges beside it
    // still meet.
    ShapeMeshes meshes(job.scene);
    const auto each_triangle = [&](const SceneLeaf& leaf, const auto& visit) {
        const ShapeMesh& mesh = meshes.of(leaf.shape, {});
        const PlacedShape placed(mesh, leaf.world_from_shape);
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const std::array<std::uint32_t, 3> t = placed.triangle(i);
            const std::array<Corner, 3> corners = {printed(placed.vertex(t[0]), unit_mm),
                                                   printed(placed.vertex(t[1]), unit_mm),
                                                   printed(placed.vertex(t[2]), unit_mm)};
            if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
                visit(corners);
        }
    };
    std::uint64_t triangles = 0;
    Box box;
    Status status = for_each_leaf(job, file, [&](const SceneLeaf& leaf) {
        each_triangle(leaf, [&](const std::array<Corner, 3>& corners) {
            ++triangles;
            for (const Corner& corner : corners)
                box.include(widened_corner(corner));
        });
    });
    if (!status.ok()) return status;
    // A head that begins with "solid" is taken for text.
    std::string head = "binary STL, millimetres; " + job.options.metadata.software;
    head.resize(stl_head_bytes - 4, ' ');
    file.text(head);
    file.number(static_cast<std::uint32_t>(triangles));
    status = for_each_leaf(job, file, [&](const SceneLeaf& leaf) {
        each_triangle(leaf, [&](const std::array<Corner, 3>& corners) {
            const Vec3 a = widened_corner(corners[0]);
            const Vec3 across = glm::cross(widened_corner(corners[1]) - a, widened_corner(corners[2]) - a);
            const double length = glm::length(across);
            const Vec3 normal = length > 0 ? across / length : Vec3(0.0);
            for (int axis = 0; axis < 3; ++axis)
                file.number(static_cast<float>(normal[axis]));
            for (const Corner& corner : corners)
                for (const float coordinate : corner)
                    file.number(coordinate);
            file.byte(0);
            file.byte(0);
        });
        file.text({});
    });
    if (status.ok()) status = file.close();
    if (!status.ok()) return status;
    const Vec3 size = box.empty() ? Vec3(0.0) : box.size();
    note_open_surfaces(job);
    report.summary =
        fmt::format("{} triangles, {:.3g} x {:.3g} x {:.3g} mm", triangles, size.x, size.y, size.z);
    return file.pending().commit();
}

} // namespace

const ExportFormat stl_format = {
    .extension = ".stl",
    .name = "STL (binary)",
    .summary = "every triangle, for printers: millimetres, z up",
    .meshes = SceneMeshes::by_size,
    .has_unit = true,
    .write = write_stl,
};

} // namespace graftal
