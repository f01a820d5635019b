#include "runtime/trace/mesh_store.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/cut/bake.h"

namespace graftal {

namespace {

/// More than fits on any picture: what is crushed coincides, and is drawn once.
constexpr std::size_t most_triangles = 2'000'000;
constexpr int endless = 1 << 20;
constexpr int steps_an_octave = 2;

int half_octaves(double value) {
    if (!std::isfinite(value)) return endless;
    return static_cast<int>(std::ceil(steps_an_octave * std::log2(std::max(value, 1e-300))));
}

double value_of(int half_octaves) {
    return half_octaves == endless ? INFINITY : std::exp2(static_cast<double>(half_octaves) / steps_an_octave);
}

/// Adds one part of a bake; its two palettes are what a node shows that inherits black and white.
void add_part(const BakedPart& part, const Affine& frame_from_body, TraceMesh& mesh) {
    const auto first_colour = static_cast<std::uint32_t>(mesh.colours.size());
    for (std::size_t slot = 0; slot < part.palettes[0].size(); ++slot)
        mesh.colours.push_back(
            {part.palettes[0][slot], part.palettes[1][slot] - part.palettes[0][slot], part.material});
    const Mesh& source = part.mesh;
    const Mat3 normal_map = glm::transpose(inverse(frame_from_body).linear);
    for (std::size_t i = 0; i < source.triangles.size(); ++i) {
        TraceMesh::Triangle triangle;
        triangle.colour = first_colour + (source.slot_count > 1 ? source.slot_of_triangle[i] : 0);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = source.triangles[i][k];
            triangle.corners[k] = frame_from_body(source.vertices[vertex]);
            triangle.normals[k] = source.normals.empty()
                                      ? Vec3(0.0)
                                      : glm::normalize(normal_map * source.normals[vertex]);
        }
        mesh.triangles.push_back(triangle);
    }
}

} // namespace

MeshStore::MeshStore(const PreparedCut& prepared, const std::vector<Affine>& graph_from_frame)
    : prepared_(prepared), graph_from_frame_(graph_from_frame) {}

const TraceMesh& MeshStore::mesh(NodeId node, std::uint32_t steps, double detail_per_unit,
                                 double pixels_per_unit) {
    const CutNode& source = prepared_.cut.nodes[node];
    // From the units of the frame to those of the graph.
    const double unit = graph_from_frame_[node].linear[0][0];
    const Key key{node, source.unending ? steps : unlimited_steps, half_octaves(detail_per_unit / unit),
                  half_octaves(pixels_per_unit / unit)};
    const std::lock_guard lock(mutex_);
    std::unique_ptr<TraceMesh>& mesh = meshes_[key];
    if (!mesh) mesh = bake_mesh(key);
    return *mesh;
}

std::unique_ptr<TraceMesh> MeshStore::bake_mesh(const Key& key) const {
    const Symmetry& symmetry = prepared_.symmetry;
    BakeRequest request;
    request.representative = symmetry.representative[key.node];
    request.steps = key.steps;
    request.detail_per_unit = value_of(key.detail);
    request.pixels_per_unit = value_of(key.pixels);
    const std::uint32_t pair = symmetry.pair[key.node];
    request.painters = {{pair, Rgb(0.0)}, {pair, Rgb(1.0)}};
    Baked baked = bake(prepared_.cut, symmetry, request, most_triangles);
    // Coarser, until it fits.
    for (; !baked.complete && std::isfinite(request.detail_per_unit); request.detail_per_unit /= 2)
        baked = bake(prepared_.cut, symmetry, request, most_triangles);
    const Affine frame_from_body = inverse(graph_from_frame_[key.node]) *
                                   symmetry.node_from_representative[key.node] * baked.representative_from_body;
    auto mesh = std::make_unique<TraceMesh>();
    for (const BakedPart& part : baked.parts)
        add_part(part, frame_from_body, *mesh);
    std::vector<BoxedItem> items;
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
        Box box;
        for (const Vec3& corner : mesh->triangles[i].corners)
            box.include(corner);
        items.emplace_back(box, 1, static_cast<std::uint32_t>(i));
    }
    mesh->tree = build_box_tree(items, mesh->boxes);
    return mesh;
}

} // namespace graftal
