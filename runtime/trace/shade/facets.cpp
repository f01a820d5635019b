#include "runtime/trace/shade/facets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/support/axes_across.h"

namespace graftal {

Vec3 visible_facet(Vec3 normal, Vec3 to_viewer, double blur, glm::dvec2 place) {
    const auto [x_axis, y_axis] = axes_across(normal);
    // Squeezed along the surface, the facets form a half sphere; the viewer sees a disc of it.
    const Vec3 seen =
        glm::normalize(Vec3(blur * glm::dot(to_viewer, x_axis), blur * glm::dot(to_viewer, y_axis),
                            std::max(0.0, glm::dot(to_viewer, normal))));
    const double across = std::hypot(seen.x, seen.y);
    const Vec3 right = across > 0 ? Vec3(-seen.y, seen.x, 0) / across : Vec3(1, 0, 0);
    const Vec3 up = glm::cross(seen, right);
    const double radius = std::sqrt(place.x), turn = 2 * std::numbers::pi * place.y;
    const double s = radius * std::cos(turn);
    const double lit = 0.5 * (1 + seen.z); // the rest of the disc lies below the surface
    const double t = (1 - lit) * std::sqrt(std::max(0.0, 1 - s * s)) + lit * radius * std::sin(turn);
    const Vec3 facet = s * right + t * up + std::sqrt(std::max(0.0, 1 - s * s - t * t)) * seen;
    return glm::normalize(blur * facet.x * x_axis + blur * facet.y * y_axis +
                          std::max(0.0, facet.z) * normal);
}

double unhidden(double cosine, double blur) {
    if (!(cosine > 0)) return 0;
    const double square = blur * blur;
    return 2 * cosine / (cosine + std::sqrt(square + (1 - square) * cosine * cosine));
}

} // namespace graftal
