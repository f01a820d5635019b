#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <glm/geometric.hpp>

#include "compiler/primitives/triangle_mesh.h"
#include "compiler/support/number.h"

// bicubic_patch(x, y, z of 16 points): the bicubic Bezier surface over four rows of four control points (G.
// Farin, "Curves and Surfaces for CAGD", chapter 14), as a smooth mesh. Every patch has as many cells, so
// that patches with a common edge have the same points on it.

namespace graftal {
namespace {

constexpr int cells = 32; ///< along each of its sides, as POV-Ray's have with `u_steps 5`
constexpr double most_coordinate = 1000;

using ControlPoints = std::array<std::array<Vec3, 4>, 4>; ///< by row

/// Bernstein's polynomials of degree three and their derivatives.
std::array<double, 4> weights(double t) {
    const double s = 1 - t;
    return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}
std::array<double, 4> slopes(double t) {
    const double s = 1 - t;
    return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
}

Vec3 sum(const ControlPoints& points, const std::array<double, 4>& along, const std::array<double, 4>& down) {
    Vec3 result(0.0);
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            result += down[row] * along[column] * points[row][column];
    return result;
}

MeshData mesh_of(const ControlPoints& points) {
    MeshData mesh;
    constexpr std::uint32_t across = cells + 1;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const double u = double(i) / cells, v = double(j) / cells;
            mesh.vertices.push_back(sum(points, weights(u), weights(v)));
            mesh.normals.push_back(
                glm::cross(sum(points, slopes(u), weights(v)), sum(points, weights(u), slopes(v))));
        }
    const auto add = [&](std::array<std::uint32_t, 3> corners) {
        std::array<std::array<double, 2>, 3> uv;
        for (std::size_t k = 0; k < 3; ++k)
            uv[k] = {double(corners[k] % across) / cells, double(corners[k] / across) / cells};
        mesh.triangles.push_back(corners);
        mesh.uv.push_back(uv);
    };
    for (std::uint32_t j = 0; j < cells; ++j)
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * across + i, b = a + 1, c = a + across, d = c + 1;
            add({a, b, d});
            add({a, d, c});
        }
    return mesh;
}

/// Where an edge has shrunk to a point the surface has no normal of its own there: the vertex gets the mean
/// of its triangles'.
void mend_normals(MeshData& mesh, double size) {
    constexpr double nothing = 1e-9; // of a normal, in squares of the size
    std::vector<Vec3> means(mesh.vertices.size(), Vec3(0.0));
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 normal = area_normal({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
        for (const std::uint32_t corner : {a, b, c})
            means[corner] += normal;
    }
    for (std::size_t i = 0; i < means.size(); ++i)
        if (!(glm::length(mesh.normals[i]) > nothing * size * size)) mesh.normals[i] = means[i];
}

std::optional<Primitive> make(std::span<const double> numbers, std::string& fault) {
    for (const double number : numbers)
        if (!(std::abs(number) <= most_coordinate)) {
            fault = "the points of a patch have coordinates between -" + shortest(most_coordinate) + " and " +
                    shortest(most_coordinate) + ", not " + shortest(number);
            return std::nullopt;
        }
    ControlPoints points;
    for (std::size_t i = 0; i < 16; ++i)
        points[i / 4][i % 4] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    MeshData mesh = mesh_of(points);
    const Vec3 size = box_about(mesh.vertices).size();
    mend_normals(mesh, std::max({size.x, size.y, size.z}));
    mesh = without_slivers(mesh);
    if (mesh.triangles.empty()) {
        fault = "the patch has no area: its points lie on a line";
        return std::nullopt;
    }
    return Primitive(PrimitiveKind::bicubic_patch,
                     std::make_shared<const TriangleMesh>(shape_name(PrimitiveKind::bicubic_patch, numbers),
                                                          std::move(mesh)));
}

} // namespace

constinit const PrimitiveTraits bicubic_patch_traits = triangle_mesh::traits({48, 48}, make);

} // namespace graftal
