#include "runtime/trace/model/mesh_store.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/detail/bake.h"
#include "compiler/detail/work.h"
#include "compiler/primitives/triangle_ray.h"

namespace graftal {

namespace {

constexpr std::size_t most_triangles = 6'000'000;
constexpr int endless = 1 << 20;
/// Octaves of sizes that share a mesh.
constexpr double octaves = 0.5;

/// Rounded up to steps.
int steps_of(double value) {
    if (!std::isfinite(value)) return endless;
    return static_cast<int>(std::ceil(std::log2(std::max(value, 1e-300)) / octaves));
}

double value_of(int steps) {
    return steps == endless ? INFINITY : std::exp2(steps * octaves);
}

/// Adds one part of a bake; its two palettes are what a node shows that inherits black and white.
void add_part(const BakedPart& part, const Affine& frame_from_body, TraceMesh& mesh) {
    const auto first_colour = static_cast<std::uint32_t>(mesh.colours.size());
    for (std::size_t slot = 0; slot < part.palettes[0].size(); ++slot)
        mesh.colours.push_back(
            {part.palettes[0][slot], part.palettes[1][slot] - part.palettes[0][slot], part.material});
    const Mesh& source = part.mesh;
    const Mat3 normal_map = glm::transpose(inverse(frame_from_body).linear);
    const auto first_vertex = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& vertex : source.vertices)
        mesh.vertices.push_back(frame_from_body(vertex));
    for (const Vec3& normal : source.normals)
        mesh.normals.push_back(glm::normalize(normal_map * normal));
    mesh.normals.resize(mesh.vertices.size(), Vec3(0.0));
    for (std::size_t i = 0; i < source.triangles.size(); ++i) {
        const auto& [a, b, c] = source.triangles[i];
        mesh.corners.push_back({first_vertex + a, first_vertex + b, first_vertex + c});
        mesh.colour_of_triangle.push_back(first_colour +
                                          (source.slot_count > 1 ? source.slot_of_triangle[i] : 0));
    }
}

std::unique_ptr<TraceMesh> trace_mesh(const Baked& baked, const Affine& frame_from_representative,
                                      const CancelFlag& cancel) {
    const Affine frame_from_body = frame_from_representative * baked.representative_from_body;
    auto mesh = std::make_unique<TraceMesh>();
    for (const BakedPart& part : baked.parts)
        add_part(part, frame_from_body, *mesh);
    std::vector<BoxedItem> items;
    for (std::uint32_t i = 0; i < mesh->corners.size(); ++i) {
        Box box;
        for (const std::uint32_t corner : mesh->corners[i])
            box.include(mesh->vertices[corner]);
        items.emplace_back(box, i);
    }
    mesh->tree = build_box_tree(items, mesh->boxes, cancel);
    return mesh;
}

} // namespace

bool intersect(const TraceMesh::Triangle& triangle, const Ray& ray, const RayRange& range,
               PrimitiveHit& hit) {
    double extent = 0;
    for (const Vec3& corner : triangle.corners)
        extent = std::max({extent, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    TriangleHit met;
    if (!TriangleRay(ray, extent).meet(triangle.corners, range, met)) return false;
    Vec3 normal(0.0);
    for (std::size_t k = 0; k < 3; ++k)
        normal += met.share[k] * triangle.normals[k];
    if (!(glm::dot(normal, normal) > 0)) normal = area_normal(triangle.corners);
    const double length = glm::length(normal);
    hit = {met.t, length > 0 ? normal / length : Vec3(0, 1, 0)};
    return true;
}

MeshStore::MeshStore(const PreparedGraph& prepared, std::uint64_t most_shell_work)
    : prepared_(prepared), most_shell_work_(most_shell_work) {}

PieceKind MeshStore::key(NodeId node, const Affine& graph_from_frame, std::uint32_t steps,
                         double detail_per_unit) const {
    // From the units of the frame to those of the graph.
    return without_idle_levels(prepared_.cut,
                               {node, steps, steps_of(detail_per_unit / graph_from_frame.linear[0][0])});
}

void MeshStore::note(double seen) {
    double before = coarsest_shell_;
    while (before < seen && !coarsest_shell_.compare_exchange_weak(before, seen)) {
    }
}

const TraceMesh& MeshStore::mesh(const PieceKind& key, const Affine& graph_from_frame) {
    std::unique_lock lock(mutex_);
    Entry& entry = meshes_[key];
    lock.unlock();
    static const TraceMesh none;
    if (!entry.made && shell_work_ > most_work_) return none;
    // Others may bake other meshes meanwhile.
    try {
        std::call_once(entry.baked, [&] {
            entry.mesh = bake_shell(key, graph_from_frame);
            entry.made = true;
        });
    } catch (const Cancelled&) { // whoever asks again makes it
        return none;
    }
    return *entry.mesh;
}

std::unique_ptr<TraceMesh> MeshStore::bake_shell(const PieceKind& key, const Affine& graph_from_frame) const {
    BakeRequest request;
    request.shell = true;
    request.shells = prepared_.shells.get();
    request.cancel = cancel_;
    request.representative = key.node;
    request.steps = key.steps;
    request.detail_per_unit = value_of(key.unit_step);
    request.most_shell_work = most_shell_work_;
    request.painters = {{0, Rgb(0.0)}, {0, Rgb(1.0)}};
    constexpr double moves_a_triangle = WorkRates::shell_points / WorkRates::mesh_triangles;
    constexpr double triangles_beside_points = 0.5; // of the work
    const auto affordable = static_cast<std::size_t>(
        triangles_beside_points * static_cast<double>(most_shell_work_) / moves_a_triangle);
    const Baked baked =
        bake(prepared_.cut, prepared_.symmetry, request, std::min(most_triangles, affordable));
    shell_work_ += baked.shell_work +
                   static_cast<std::uint64_t>(moves_a_triangle * static_cast<double>(baked.triangles));
    auto mesh = trace_mesh(baked, inverse(graph_from_frame), cancel_);
    mesh->cell = baked.culled_detail / request.detail_per_unit / graph_from_frame.linear[0][0];
    return mesh;
}

} // namespace graftal
