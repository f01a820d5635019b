#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "compiler/support/affine.h"

namespace graftal {

/// Fits ellipsoids to areas of shadows. The square of an ellipsoid's is a quadratic form of the direction,
/// pi^2 det(L)^2 d^T (L L^T)^-1 d: this form is fitted, and L follows from it.
class EllipsoidFit {
  public:
    /// Directions along which shadows are taken: unit vectors, six or more, not on one cone.
    explicit EllipsoidFit(std::span<const Vec3> directions);

    /// The form next to the squares of the areas.
    Eigen::Matrix3d form(const std::vector<double>& areas) const;

    /// The ellipsoid about the origin of that form, scaled so that its mean shadow is `mean`; no half axis
    /// reaches far beyond `box_half`, where that leaves area enough.
    Mat3 ellipsoid(const Eigen::Matrix3d& form, double mean, Vec3 box_half) const;

  private:
    double mean_shadow(const Mat3& linear) const;

    std::vector<Vec3> directions_;
    Eigen::MatrixXd solve_;
};

} // namespace graftal
