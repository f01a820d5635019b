#include "compiler/cut/least_width.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/SVD>
#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"

namespace graftal {

namespace {

const Ball& ball_of(PrimitiveKind kind) {
    static const std::array<Ball, primitive_kind_count> balls = [] {
        std::array<Ball, primitive_kind_count> all;
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = primitive_bounds(static_cast<PrimitiveKind>(i)).ball;
        return all;
    }();
    return balls[static_cast<std::size_t>(kind)];
}

/// Of the largest ball or disc in a primitive, or nearly.
double inner_radius(PrimitiveKind kind) {
    const bool small =
        kind != PrimitiveKind::sphere && kind != PrimitiveKind::cube && kind != PrimitiveKind::torus;
    return small ? 0.5 : 1;
}

/// At least the square of the longest half axis.
double squared_entries(const Mat3& m) {
    return glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
}

bool has_right_angles(const Mat3& m) {
    constexpr double rounding = 1e-12;
    for (int i = 0; i < 3; ++i) {
        const Vec3 &a = m[i], &b = m[(i + 1) % 3];
        const double ab = glm::dot(a, b);
        if (!(ab * ab <= rounding * rounding * glm::dot(a, a) * glm::dot(b, b))) return false;
    }
    return glm::dot(m[0], m[0]) > 0 && glm::dot(m[1], m[1]) > 0 && glm::dot(m[2], m[2]) > 0;
}

/// The half axes that are too short, longer.
Mat3 widened(const Mat3& place, double half_width) {
    Eigen::Matrix3d linear;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            linear(row, column) = place[column][row];
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d sigma = svd.singularValues().cwiseMax(half_width);
    const Eigen::Matrix3d wide = svd.matrixU() * sigma.asDiagonal() * svd.matrixV().transpose();
    Mat3 result;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            result[column][row] = wide(row, column);
    return result;
}

} // namespace

double half_width_needed(const Affine& place, bool faint, double half_width) {
    constexpr double thinnest_share = 1e-3, thickest_share = 1.0 / 8;
    if (faint && half_width > 0) return half_width;
    if (!is_singular(place, flattest_leaf)) return 0;
    const Vec3 sigma = singular_values(place.linear);
    if (!(half_width > 0)) return thinnest_share * sigma.x;
    const bool line = !(sigma.y > flattest_leaf * sigma.x);
    return line ? half_width : std::min(half_width, thickest_share * sigma.x);
}

Affine widened(PrimitiveKind kind, const Affine& place, double radius) {
    if (!(radius > 0)) return place;
    const double half_width = radius / inner_radius(kind);
    // A ball is one whichever way it is turned. What is culled is smaller, so that this is most of what is
    // widened.
    if (kind == PrimitiveKind::sphere && squared_entries(place.linear) <= half_width * half_width)
        return {Mat3(half_width), place.translation};
    Affine result = place;
    if (has_right_angles(place.linear)) // the columns are the half axes
        for (int i = 0; i < 3; ++i)
            result.linear[i] *= std::max(1.0, half_width / glm::length(place.linear[i]));
    else
        result.linear = widened(place.linear, half_width);
    const Vec3 middle = ball_of(kind).centre;
    result.translation = place(middle) - result.linear * middle;
    return result;
}

Ball widened_ball(PrimitiveKind kind, const Affine& place, double radius) {
    const Ball& ball = ball_of(kind);
    const double stretch = std::sqrt(squared_entries(place.linear));
    return {place(ball.centre), ball.radius * std::max(stretch, radius / inner_radius(kind))};
}

double widened_reach(PrimitiveKind kind) {
    return ball_of(kind).radius / inner_radius(kind);
}

Affine speck_mark(const Affine& place, double half_width) {
    Affine mark{Mat3(std::exp2(std::round(std::log2(norm(place.linear))))), {}};
    for (int k = 0; k < 3; ++k)
        mark.translation[k] = 0.5 * half_width * std::round(place.translation[k] / (0.5 * half_width));
    return mark;
}

} // namespace graftal
