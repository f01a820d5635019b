#include "compiler/detail/least_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/primitives/primitive.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

double inner_radius(const Primitive& primitive) {
    return traits_of(primitive).inner_radius(primitive);
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

/// Two unit vectors across a unit vector, and across each other; right-handed (J. Hughes and T. Moeller,
/// "Building an Orthonormal Basis from a Unit Vector", 1999).
std::array<Vec3, 2> across(Vec3 unit) {
    const Vec3 other =
        std::abs(unit.x) > std::abs(unit.z) ? Vec3(-unit.y, unit.x, 0) : Vec3(0, -unit.z, unit.y);
    const Vec3 first = glm::normalize(other);
    return {first, glm::cross(unit, first)};
}

/// Makes a part round that is a line as far as this width shows.
Mat3 widened_line(const Mat3& place, double half_width) {
    const Vec3* longest = &place[0];
    for (int i = 1; i < 3; ++i)
        if (glm::dot(place[i], place[i]) > glm::dot(*longest, *longest)) longest = &place[i];
    const Vec3 to = glm::normalize(*longest);
    const auto [from_1, from_2] = across(glm::normalize(to * place)); // the transpose of `place`, of `to`
    const auto [to_1, to_2] = across(to);
    return place + half_width * (glm::outerProduct(to_1, from_1) + glm::outerProduct(to_2, from_2));
}

/// flat_map() of a map, which is asked for where it is first needed and not again.
class FlatOnce {
  public:
    explicit FlatOnce(const Mat3& map) : map_(map) {}

    const std::optional<FlatMap>& operator()() {
        if (!known_) known_ = flat_map(map_);
        return *known_;
    }

  private:
    const Mat3& map_;
    std::optional<std::optional<FlatMap>> known_;
};

/// The half axes that are too short, longer.
Mat3 widened(const Mat3& place, double half_width, FlatOnce& flat_once) {
    constexpr double unseen = 1e-2;
    const Vec3 most = most_singular_values(place);
    if (most.x > half_width && most.y <= unseen * half_width) return widened_line(place, half_width);
    const std::optional<FlatMap>& flat = flat_once();
    if (flat && flat->sigma.y >= half_width)
        return place + std::max(0.0, half_width - flat->sigma.z) * flat->thickening;
    const Eigen::Map<const Eigen::Matrix3d> linear(&place[0][0]); // both go by columns
    Mat3 result;
    Eigen::Map<Eigen::Matrix3d> wide(&result[0][0]);
    // Eigenvalues of the squares, in closed form: much faster, and exact enough for half axes of one order.
    constexpr double alike = 1e-3;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squares;
    squares.computeDirect(linear.transpose() * linear);
    const Eigen::Vector3d eigenvalues = squares.eigenvalues(); // the least first
    if (eigenvalues[0] > alike * alike * eigenvalues[2] && eigenvalues[0] > 1e-200) {
        const Eigen::Vector3d factors = (half_width * eigenvalues.array().rsqrt()).cwiseMax(1.0);
        const Eigen::Matrix3d& axes = squares.eigenvectors();
        wide = linear * axes * factors.asDiagonal() * axes.transpose();
        return result;
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d sigma = svd.singularValues().cwiseMax(half_width);
    wide = svd.matrixU() * sigma.asDiagonal() * svd.matrixV().transpose();
    return result;
}

double half_width_needed(const Affine& place, bool faint, double half_width, FlatOnce& flat_once) {
    constexpr double thinnest_share = 1e-3, thickest_share = 1.0 / 8;
    if (faint && half_width > 0) return half_width;
    Vec3 sigma;
    if (const std::optional<Vec3> line = line_values(place.linear)) {
        sigma = *line;
        if (sigma.z > flattest_leaf * sigma.x) return 0;
    } else {
        const std::optional<FlatMap>& flat = flat_once();
        if (flat ? flat->sigma.z > flattest_leaf * flat->sigma.x : !is_singular(place, flattest_leaf))
            return 0;
        sigma = flat ? flat->sigma : singular_values(place.linear);
    }
    if (!(half_width > 0)) return thinnest_share * sigma.x;
    const bool line = !(sigma.y > flattest_leaf * sigma.x);
    return line ? half_width : std::min(half_width, thickest_share * sigma.x);
}

Affine widened(const Primitive& primitive, const Affine& place, double radius, FlatOnce& flat_once) {
    if (!(radius > 0)) return place;
    const double half_width = radius / inner_radius(primitive);
    // A ball is one whichever way it is turned. What is culled is smaller, so that this is most of what is
    // widened.
    if (primitive == PrimitiveKind::sphere && squared_entries(place.linear) <= half_width * half_width)
        return {Mat3(half_width), place.translation};
    Affine result = place;
    if (has_right_angles(place.linear)) // the columns are the half axes
        for (int i = 0; i < 3; ++i)
            result.linear[i] *= std::max(1.0, half_width / glm::length(place.linear[i]));
    else
        result.linear = widened(place.linear, half_width, flat_once);
    const Vec3 middle = traits_of(primitive).ball(primitive).centre;
    result.translation = place(middle) - result.linear * middle;
    return result;
}

} // namespace

double half_width_needed(const Affine& place, bool faint, double half_width) {
    FlatOnce flat(place.linear);
    return half_width_needed(place, faint, half_width, flat);
}

Affine widened(const Primitive& primitive, const Affine& place, double radius) {
    FlatOnce flat(place.linear);
    return widened(primitive, place, radius, flat);
}

DrawnLeaf drawn_leaf(const Primitive& primitive, const Affine& place, bool faint, double half_width) {
    FlatOnce flat(place.linear);
    const double needed = half_width_needed(place, faint, half_width, flat);
    return {widened(primitive, place, needed, flat), needed};
}

Ball widened_ball(const Primitive& primitive, const Affine& place, double radius) {
    const Ball ball = traits_of(primitive).ball(primitive);
    const double stretch = most_stretch(place.linear);
    return {place(ball.centre), ball.radius * std::max(stretch, radius / inner_radius(primitive))};
}

double widened_reach(const Primitive& primitive) {
    return traits_of(primitive).ball(primitive).radius / inner_radius(primitive);
}

Affine speck_mark(const Affine& place, double half_width) {
    Affine mark{Mat3(std::exp2(std::round(std::log2(largest_stretch(place.linear))))), {}};
    for (int k = 0; k < 3; ++k)
        mark.translation[k] = 0.5 * half_width * std::round(place.translation[k] / (0.5 * half_width));
    return mark;
}

} // namespace graftal
