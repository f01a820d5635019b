#include "compiler/detail/shadow/ellipsoid_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "compiler/detail/shadow/shadow.h"

namespace graftal {

namespace {

/// No shadow of a proxy is narrower than this share of its widest, so that flat sets have a body.
constexpr double narrowest_shadow = 0.02;
/// A half axis may be this much longer than half the node's box: an ellipsoid with a cube's shadow is.
constexpr double reach_beyond_box = 1.5;

Mat3 turned(const Eigen::Matrix3d& axes, const Eigen::Vector3d& half) {
    Mat3 linear(0.0);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            linear[i][k] = axes(k, i) * half[i];
    return linear;
}

} // namespace

EllipsoidFit::EllipsoidFit(std::span<const Vec3> directions)
    : directions_(directions.begin(), directions.end()) {
    Eigen::MatrixXd terms(directions.size(), 6);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3& d = directions[i];
        terms.row(static_cast<Eigen::Index>(i)) << d.x * d.x, d.y * d.y, d.z * d.z, 2 * d.x * d.y,
            2 * d.y * d.z, 2 * d.z * d.x;
    }
    solve_ = terms.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::Matrix3d EllipsoidFit::form(const std::vector<double>& areas) const {
    Eigen::VectorXd squares(static_cast<Eigen::Index>(areas.size()));
    for (std::size_t i = 0; i < areas.size(); ++i)
        squares[static_cast<Eigen::Index>(i)] = areas[i] * areas[i];
    const Eigen::VectorXd q = solve_ * squares;
    Eigen::Matrix3d form;
    form << q[0], q[3], q[5], q[3], q[1], q[4], q[5], q[4], q[2];
    return form;
}

Mat3 EllipsoidFit::ellipsoid(const Eigen::Matrix3d& form, double mean, Vec3 box_half) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(form);
    const Eigen::Matrix3d& axes = solver.eigenvectors();
    const double widest = std::sqrt(std::max(solver.eigenvalues()[2], 1e-300));
    Eigen::Vector3d half, limit;
    for (int i = 0; i < 3; ++i) {
        const auto shadow = [&](int k) {
            return std::max(std::sqrt(std::max(solver.eigenvalues()[k % 3], 0.0)), narrowest_shadow * widest);
        };
        half[i] = std::sqrt(shadow(i + 1) * shadow(i + 2) / shadow(i));
        limit[i] = 0;
        for (int k = 0; k < 3; ++k)
            limit[i] += reach_beyond_box * std::abs(axes(k, i)) * box_half[k];
    }
    // Where no axis is held back, areas grow with the square.
    const double free = std::sqrt(mean / mean_shadow(turned(axes, half)));
    if (((free * half).array() <= limit.array()).all()) return turned(axes, free * half);
    const auto scaled = [&](double scale) { return turned(axes, (scale * half).cwiseMin(limit)); };
    double low = free, high = 1e3 * free;
    for (int step = 0; step < 40; ++step) {
        const double middle = std::sqrt(low * high);
        (mean_shadow(scaled(middle)) < mean ? low : high) = middle;
    }
    return scaled(high);
}

double EllipsoidFit::mean_shadow(const Mat3& linear) const {
    double sum = 0;
    for (const Vec3& direction : directions_)
        sum += projected_area({linear, Vec3(0.0)}, direction);
    return sum / static_cast<double>(directions_.size());
}

} // namespace graftal
