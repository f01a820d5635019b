#include "runtime/inverse/space_map.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// A linear part as rotation * diagonal(stretches) * rotation, each of which may mirror.
struct SpaceStretch {
    Mat3 left{1.0};
    Vec3 factors{0.0}; ///< not negative, largest first
    Mat3 right{1.0};
};

Mat3 glm_of(const Eigen::Matrix3d& m) {
    Mat3 result;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            result[column][row] = m(row, column);
    return result;
}

SpaceStretch stretch_of(const Mat3& linear) {
    const Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix3d>(&linear[0][0]); // both by columns
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (svd.info() != Eigen::Success) return {}; // entries that are no numbers
    const Eigen::Vector3d& s = svd.singularValues();
    return {glm_of(svd.matrixU()), {s(0), s(1), s(2)}, glm_of(svd.matrixV().transpose())};
}

Mat3 linear_of(const Mat3& left, Vec3 factors, const Mat3& right) {
    return Mat3(factors.x * left[0], factors.y * left[1], factors.z * left[2]) * right;
}

/// All rotations as likely: a quaternion of four normal numbers (Muller 1959).
Mat3 random_rotation(Draws& draws) {
    double w = 0, x = 0, y = 0, z = 0, squared = 0;
    while (squared < 1e-12) {
        w = draws.normal(), x = draws.normal(), y = draws.normal(), z = draws.normal();
        squared = w * w + x * x + y * y + z * z;
    }
    const double s = 2 / squared;
    return {1 - s * (y * y + z * z), s * (x * y + w * z),     s * (x * z - w * y),
            s * (x * y - w * z),     1 - s * (x * x + z * z), s * (y * z + w * x),
            s * (x * z + w * y),     s * (y * z - w * x),     1 - s * (x * x + y * y)};
}

std::array<double, SpaceMap::entries> step_of(const Mat3& linear, Vec3 shift) {
    std::array<double, SpaceMap::entries> step{};
    for (std::size_t row = 0; row < 3; ++row) {
        const auto of_row = static_cast<int>(row);
        for (std::size_t column = 0; column < 3; ++column)
            step[4 * row + column] = linear[static_cast<int>(column)][of_row];
        step[4 * row + 3] = shift[of_row];
    }
    return step;
}

} // namespace

double SpaceMap::determinant() const {
    return glm::determinant(linear);
}

std::array<double, 12> SpaceMap::log_slope() const {
    const Mat3& m = linear;
    double size = determinant();
    if (std::abs(size) < 1e-10) size = 1e-10;
    const Mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return step_of((1 / size) * cofactors, Vec3(0.0));
}

std::array<std::array<double, 12>, 7> SpaceMap::similar_steps() const {
    const double size = std::sqrt(std::max(1e-12, squared_entries(linear) / 3));
    const Mat3 turned = (1 / size) * linear;
    std::array<std::array<double, 12>, 7> steps;
    steps[0] = step_of(turned, Vec3(0.0));
    for (std::size_t k = 0; k < 3; ++k) {
        Vec3 axis(0.0);
        axis[static_cast<int>(k)] = 1;
        const Mat3 turn(glm::cross(axis, turned[0]), glm::cross(axis, turned[1]),
                        glm::cross(axis, turned[2]));
        steps[1 + k] = step_of(turn, Vec3(0.0));
        steps[4 + k] = step_of(Mat3(0.0), axis);
    }
    return steps;
}

SpaceMap SpaceMap::random(bool missed, bool similar, Draws& draws) {
    Vec3 factors(std::exp(draws.between(std::log(missed ? 0.05 : 0.12), std::log(0.85))));
    if (!similar) {
        factors.y *= std::exp(-0.3 * std::abs(draws.normal()));
        factors.z *= std::exp(-0.3 * std::abs(draws.normal()));
        if (missed && draws.unit() < 0.15) { // a sheet or a stem
            factors.z *= 0.02;
            if (draws.unit() < 0.5) factors.y *= 0.02;
        }
    }
    if (draws.unit() < 0.5) factors = -factors;
    const Mat3 left = random_rotation(draws);
    return {{linear_of(left, factors, random_rotation(draws)), Vec3(0.0)}};
}

double largest_stretch(const SpaceMaps& maps) {
    double largest = 0;
    for (const SpaceMap& map : maps)
        largest = std::max(largest, norm(map.linear));
    return largest;
}

SpaceMap moved(const SpaceMap& map, const double* step, Vec3 centre, double most) {
    SpaceMap result = map;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            result.linear[column][row] += step[4 * row + column];
    if (squared_entries(result.linear) > most * most && largest_stretch(result.linear) > most) {
        const SpaceStretch s = stretch_of(result.linear);
        result.linear = linear_of(s.left, glm::min(s.factors, Vec3(most)), s.right);
    }
    return result.taking(centre, map(centre) + Vec3(step[3], step[7], step[11]));
}

SpaceMap nearest_similarity(const SpaceMap& map, Vec3 centre) {
    const SpaceStretch s = stretch_of(map.linear);
    const Vec3 mean((s.factors.x + s.factors.y + s.factors.z) / 3);
    return SpaceMap{{linear_of(s.left, mean, s.right), Vec3(0.0)}}.taking(centre, map(centre));
}

SpaceMap bounded_inverse(const SpaceMap& map, Vec3 centre, double least) {
    const SpaceStretch s = stretch_of(map.linear);
    const Vec3 factors = 1.0 / glm::max(s.factors, Vec3(least));
    const Mat3 back = linear_of(glm::transpose(s.right), factors, glm::transpose(s.left));
    return SpaceMap{{back, Vec3(0.0)}}.taking(map(centre), centre);
}

Vec3 fixed_point(const SpaceMap& map) {
    return glm::inverse(Mat3(1.0) - map.linear) * map.translation;
}

} // namespace graftal
