#include "compiler/support/affine.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/support/angle.h"
#include "compiler/support/check.h"
#include "compiler/support/jacobi.h"
#include "compiler/support/stretch.h"

namespace graftal {

Affine Affine::rotate(Vec3 axis, double angle_deg) {
    const double length = glm::length(axis);
    GRAFTAL_CHECK(length > 0, "rotation about a zero axis");
    const Vec3 u = axis / length;
    const auto [c, s] = cos_sin_deg(angle_deg);
    const Mat3 cross(0, u.z, -u.y, -u.z, 0, u.x, u.y, -u.x, 0);
    return {c * Mat3(1.0) + (1 - c) * glm::outerProduct(u, u) + s * cross, Vec3(0.0)};
}

Affine inverse(const Affine& a) {
    const Mat3 linear = glm::inverse(a.linear);
    return {linear, -(linear * a.translation)};
}

Vec3 singular_values(const Mat3& linear) {
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(linear[column][row]));
    if (largest == 0 || !std::isfinite(largest)) return Vec3(largest);
    // Brought near 1 by a power of two, without rounding, so that no square overflows or vanishes. In two
    // steps, for the factor itself may overflow.
    const int exponent = std::ilogb(largest);
    const double half_scale = std::exp2(-exponent / 2), rest_scale = std::exp2(-exponent - -exponent / 2);

    Mat3 a = linear * half_scale * rest_scale;
    make_columns_orthogonal(a);
    Vec3 lengths(glm::length(a[0]), glm::length(a[1]), glm::length(a[2]));
    if (lengths.x < lengths.y) std::swap(lengths.x, lengths.y);
    if (lengths.y < lengths.z) std::swap(lengths.y, lengths.z);
    if (lengths.x < lengths.y) std::swap(lengths.x, lengths.y);
    return lengths / half_scale / rest_scale;
}

double norm(const Mat3& linear) {
    return singular_values(linear).x;
}

bool is_finite(const Affine& a) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!std::isfinite(a.linear[column][row])) return false;
    return std::isfinite(a.translation.x) && std::isfinite(a.translation.y) && std::isfinite(a.translation.z);
}

bool is_singular(const Affine& a, double relative) {
    return flatness_over(relative, a.linear) == 0;
}

double largest_entry(Vec3 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double largest_entry(const Mat3& matrix) {
    return std::max({largest_entry(matrix[0]), largest_entry(matrix[1]), largest_entry(matrix[2])});
}

} // namespace graftal
