#include "compiler/primitives/round_mesh.h"

#include <cmath>
#include <numbers>

namespace graftal {

using std::numbers::pi;

double balanced_radius(int sides) {
    return 2 / (1 + std::cos(pi / sides));
}

double balanced_error(int sides) {
    return std::pow(std::tan(pi / (2 * sides)), 2);
}

Vec3 spoke(int i, int n) {
    const double angle = 2 * pi * (i % n) / n;
    return {std::sin(angle), 0, std::cos(angle)};
}

std::uint32_t add_vertex(TessellatedPrimitive& mesh, Vec3 position, Vec3 normal) {
    mesh.vertices.push_back(position);
    mesh.normals.push_back(normal);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

} // namespace graftal
