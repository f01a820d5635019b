#pragma once

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "runtime/trace/lanes.h"

namespace graftal {

/// norm(), to about 1e-8, and an order of magnitude faster: the root of the largest eigenvalue of A^T A,
/// which solves a cubic (O. Smith, "Eigenvalues of a symmetric 3x3 matrix", 1961).
inline double largest_stretch(const LaneMap& map) {
    const Vec3 a = vec3_of(map.column[0]), b = vec3_of(map.column[1]), c = vec3_of(map.column[2]);
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), cc = glm::dot(c, c);
    const double mean = (aa + bb + cc) / 3;
    if (!(mean > 1e-250)) return norm(map.affine().linear);
    if (a.z == 0 && b.z == 0 && c.x == 0 && c.y == 0) { // of the plane, as most: a quadratic will do
        const double sum = std::sqrt((a.x + b.y) * (a.x + b.y) + (a.y - b.x) * (a.y - b.x));
        const double difference = std::sqrt((a.x - b.y) * (a.x - b.y) + (a.y + b.x) * (a.y + b.x));
        return std::max(0.5 * (sum + difference), std::abs(c.z));
    }
    // Of the matrix less its mean eigenvalue, in units of that.
    const double x = aa / mean - 1, y = bb / mean - 1, z = cc / mean - 1;
    const double xy = glm::dot(a, b) / mean, yz = glm::dot(b, c) / mean, zx = glm::dot(c, a) / mean;
    const double p2 = (x * x + y * y + z * z + 2 * (xy * xy + yz * yz + zx * zx)) / 6;
    if (!(p2 > 0)) return std::sqrt(mean);
    const double p = std::sqrt(p2);
    const double determinant = x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
    const double angle = std::acos(std::clamp(0.5 * determinant / (p2 * p), -1.0, 1.0)) / 3;
    return std::sqrt(mean * (1 + 2 * p * std::cos(angle)));
}

} // namespace graftal
