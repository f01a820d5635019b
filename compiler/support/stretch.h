#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "compiler/support/affine.h"

// Stretches of maps, without a decomposition.

namespace graftal {

/// norm(), to about 1e-8, and an order of magnitude faster: the root of the largest eigenvalue of A^T A,
/// which solves a cubic (O. Smith, "Eigenvalues of a symmetric 3x3 matrix", 1961).
inline double largest_stretch(const Mat3& map) {
    const Vec3 &a = map[0], &b = map[1], &c = map[2];
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), cc = glm::dot(c, c);
    const double mean = (aa + bb + cc) / 3;
    if (!(mean > 1e-250)) return norm(map);
    if (a.z == 0 && b.z == 0 && c.x == 0 && c.y == 0) { // of the plane, as most: a quadratic will do
        const double sum = std::sqrt((a.x + b.y) * (a.x + b.y) + (a.y - b.x) * (a.y - b.x));
        const double difference = std::sqrt((a.x - b.y) * (a.x - b.y) + (a.y + b.x) * (a.y + b.x));
        return std::max(0.5 * (sum + difference), std::abs(c.z));
    }
    // Entries of the matrix less its mean eigenvalue, in units of that.
    const double x = aa / mean - 1, y = bb / mean - 1, z = cc / mean - 1;
    const double xy = glm::dot(a, b) / mean, yz = glm::dot(b, c) / mean, zx = glm::dot(c, a) / mean;
    const double p2 = (x * x + y * y + z * z + 2 * (xy * xy + yz * yz + zx * zx)) / 6;
    if (!(p2 > 0)) return std::sqrt(mean);
    const double p = std::sqrt(p2);
    const double determinant = x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
    const double angle = std::acos(std::clamp(0.5 * determinant / (p2 * p), -1.0, 1.0)) / 3;
    return std::sqrt(mean * (1 + 2 * p * std::cos(angle)));
}

/// The squares of the singular values, added: at least that of the largest.
inline double squared_entries(const Mat3& map) {
    return glm::dot(map[0], map[0]) + glm::dot(map[1], map[1]) + glm::dot(map[2], map[2]);
}

/// At least largest_stretch(), and at most 1.8 times as much.
inline double most_stretch(const Mat3& map) {
    return std::sqrt(squared_entries(map));
}

/// A map that leaves a ball hardly any thickness, but more than a line.
struct FlatMap {
    Vec3 sigma; ///< its singular values, largest first; the least to about 1e-10 of the largest
    /// Added times a length, it makes the image of the unit ball thicker by that; nothing else changes by
    /// more than 1e-5 of it.
    Mat3 thickening;
};

/// None where the least singular value is over 1e-5 of the middle one, or that is under 1e-5 of the largest:
/// such maps need singular_values(), which take ten times as long. Cofactors are products of two singular
/// values each: of a flat map their matrix is the product of the two larger ones, times the directions of the
/// least.
std::optional<FlatMap> flat_map(const Mat3& linear);

/// The singular values of what is crushed nearly to a line: none where the middle one is over 1e-4 of the
/// largest. The middle one is up to sqrt(2) times too large, and the least one as much too small, where these
/// two are alike.
std::optional<Vec3> line_values(const Mat3& linear);

/// At least the singular values, largest first, and at most three times as much; no decomposition. The least
/// one of what is crushed to a line is given as no more than the middle one.
Vec3 most_singular_values(const Mat3& linear);

/// Whether the least singular value is more than that share of the largest, and then a lower bound of it: a
/// share that is larger. 0 where it is not. Asks for a decomposition only in narrow doubt. Requires a share
/// of 1e-13 or more.
double flatness_over(double share, const Mat3& linear);

/// Planes that a map makes flatter than this are taken where place_of_plane() says.
inline constexpr double flattest_plane = 1e-9;

/// Where a nearly singular map takes the plane y = 0: the same place without the map's tiny or missing
/// stretch. Nothing where it becomes a line.
std::optional<Affine> place_of_plane(const Affine& map);

} // namespace graftal
