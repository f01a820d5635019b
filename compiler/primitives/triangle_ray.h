#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/primitives/shape_parts.h"
#include "compiler/support/ray.h"

namespace graftal {

/// Where a ray meets a triangle: the shares of its corners there add up to 1.
struct TriangleHit {
    double t = 0;
    std::array<double, 3> share{};
};

/// A ray that meets triangles without a gap between neighbours: S. Woop, C. Benthin and I. Wald, "Watertight
/// Ray/Triangle Intersection", JCGT 2(1), 2013. A shear turns the ray into an axis. The side on which the ray
/// passes an edge then depends on the two corners of the edge alone. A ray that passes nearer to an edge than
/// `seam` meets the triangles on both sides of it: two maps may have brought the corners of neighbours to
/// places that differ a little.
class TriangleRay {
  public:
    /// `extent`: the largest coordinate of the triangles.
    TriangleRay(const Ray& ray, double extent) : origin_(ray.origin) {
        const Vec3 size(std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z));
        z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        x_ = (z_ + 1) % 3;
        y_ = (z_ + 2) % 3;
        slope_z_ = 1 / ray.direction[z_];
        slope_x_ = ray.direction[x_] * slope_z_;
        slope_y_ = ray.direction[y_] * slope_z_;
        farthest_ = extent + std::max({std::abs(origin_.x), std::abs(origin_.y), std::abs(origin_.z)});
    }

    /// Meets it from either side, but not edge-on.
    bool meet(const Triangle& triangle, const RayRange& range, TriangleHit& hit) const {
        std::array<double, 3> x, y, z;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 corner = triangle[k] - origin_;
            z[k] = corner[z_];
            x[k] = corner[x_] - slope_x_ * z[k];
            y[k] = corner[y_] - slope_y_ * z[k];
        }
        std::array<double, 3> side; // of the ray, from the edge opposite to each corner: twice an area
        double length = 0;
        bool left = false, right = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
            side[k] = x[b] * y[a] - y[b] * x[a];
            const double edge = std::abs(x[a] - x[b]) + std::abs(y[a] - y[b]);
            left = left || side[k] > seam * farthest_ * edge;
            right = right || side[k] < -seam * farthest_ * edge;
            length += edge;
        }
        const double whole = side[0] + side[1] + side[2];
        if ((left && right) || !(std::abs(whole) > rounding * farthest_ * length)) return false;
        hit.t = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            hit.share[k] = side[k] / whole;
            if (hit.share[k] < -1) return false; // beside a triangle that is smaller than a seam
            hit.t += hit.share[k] * z[k] * slope_z_;
        }
        return hit.t > range.least && hit.t < range.most;
    }

    /// A share of the largest coordinate.
    static constexpr double seam = 1e-12;

  private:
    /// The rounding error of a coordinate after some operations, as a share of the largest.
    static constexpr double rounding = 8 * 0x1p-52;

    Vec3 origin_;
    int x_, y_, z_; ///< z: the axis along which the ray goes most
    double slope_x_, slope_y_, slope_z_;
    double farthest_;
};

} // namespace graftal
