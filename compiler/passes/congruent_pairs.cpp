#include "compiler/passes/congruent_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "compiler/analysis/bounding.h"

namespace graftal {

namespace {

constexpr double tolerance = 1e-9;

bool near_zero(const Mat3& m, double scale) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(m[column][row]) > tolerance * scale) return false;
    return true;
}

bool fixes_y_axis(const Mat3& m) {
    return std::abs(m[1][0]) < tolerance && std::abs(m[1][2]) < tolerance && std::abs(m[0][1]) < tolerance &&
           std::abs(m[2][1]) < tolerance;
}

std::vector<Mat3> signed_permutations() {
    std::vector<Mat3> all;
    std::array<int, 3> order = {0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Mat3 m(0.0);
            for (int column = 0; column < 3; ++column)
                m[column][order[column]] = (signs >> column & 1) ? -1.0 : 1.0;
            all.push_back(m);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
}

} // namespace

const std::vector<Mat3>& cube_symmetries() {
    static const std::vector<Mat3> all = signed_permutations();
    return all;
}

bool is_isometry(const Mat3& linear) {
    return near_zero(glm::transpose(linear) * linear - Mat3(1.0), 1);
}

bool preserves(PrimitiveKind kind, const Affine& a) {
    if (kind == PrimitiveKind::triangle) {
        const std::array<Vec3, 3> corners = triangle_corners();
        for (const Vec3& corner : corners) {
            const bool lands = std::any_of(corners.begin(), corners.end(), [&](const Vec3& other) {
                return glm::distance(a(corner), other) < tolerance;
            });
            if (!lands) return false;
        }
        return true;
    }
    if (glm::length(a.translation) > tolerance || !is_isometry(a.linear)) return false;
    switch (kind) {
    case PrimitiveKind::sphere:
        return true;
    case PrimitiveKind::cube:
        // Orthogonal with columns of 1-norm 1: a signed permutation.
        return std::abs(glm::dot(glm::abs(a.linear[0]), Vec3(1.0)) - 1) < tolerance &&
               std::abs(glm::dot(glm::abs(a.linear[1]), Vec3(1.0)) - 1) < tolerance;
    case PrimitiveKind::torus:
        return fixes_y_axis(a.linear);
    default:
        return fixes_y_axis(a.linear) && a.linear[1][1] > 0;
    }
}

bool takes_ellipsoid(const Affine& map, const Affine& from, const Affine& to) {
    const Affine moved = map * from;
    const Mat3 x = moved.linear * glm::transpose(moved.linear);
    const Mat3 y = to.linear * glm::transpose(to.linear);
    const double size = norm(y);
    return near_zero(x - y, 10 * size) &&
           glm::distance(moved.translation, to.translation) <= 1e-7 * std::sqrt(size);
}

Vec3 centre_of(PrimitiveKind kind) {
    const bool standing = kind == PrimitiveKind::cylinder || kind == PrimitiveKind::cone ||
                          family_of(kind) == PrimitiveKind::frustum;
    return standing ? Vec3(0, 0.5, 0) : Vec3(0.0);
}

} // namespace graftal
