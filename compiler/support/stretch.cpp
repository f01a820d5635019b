#include "compiler/support/stretch.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

/// Symmetric functions of the singular values of a map.
struct Symmetric {
    Mat3 cofactors;
    double squares = 0;      ///< of the three, added
    double squared_area = 0; ///< squares of the products of two, added
    double volume = 0;       ///< the product, or less that
    double rounding = 0;     ///< of the volume, at most
    /// Powers of larger and smaller ones are no numbers any more.
    bool in_range = false;

    explicit Symmetric(const Mat3& m)
        : cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])),
          squares(squared_entries(m)), squared_area(squared_entries(cofactors)),
          volume(glm::dot(m[0], cofactors[0])), rounding(1e-15 * squares * std::sqrt(squares)),
          in_range(squares > 1e-100 && squares < 1e80 && squared_area > 1e-250) {}
};

} // namespace

std::optional<FlatMap> flat_map(const Mat3& linear) {
    constexpr double thickest =
        1e-5; // as a share of the middle singular value: its square is lost in the answer
    constexpr double narrowest = 1e-5; // of the middle one itself: less has no exact cofactors
    const Symmetric all(linear);
    if (!all.in_range) return {};
    const double root = std::sqrt(std::max(0.0, all.squares * all.squares - 4 * all.squared_area));
    const double longest = std::sqrt(0.5 * (all.squares + root)), area = std::sqrt(all.squared_area);
    const double middle = area / longest, thickness = std::abs(all.volume) / area;
    if (!(middle > narrowest * longest && thickness <= thickest * middle)) return {};
    return FlatMap{{longest, middle, thickness}, std::copysign(1 / area, all.volume) * all.cofactors};
}

std::optional<Vec3> line_values(const Mat3& linear) {
    constexpr double thickest = 1e-4;
    const Symmetric all(linear);
    if (!(all.squares > 1e-100 && all.squares < 1e80)) return {};
    // The other two add less to the squares than rounding does.
    const double longest = std::sqrt(all.squares), area = std::sqrt(all.squared_area);
    if (!(area <= thickest * all.squares)) return {};
    return Vec3(longest, area / longest,
                area > 0 ? std::min(std::abs(all.volume), area * area / longest) / area : 0);
}

Vec3 most_singular_values(const Mat3& linear) {
    const Symmetric all(linear);
    if (!all.in_range) return singular_values(linear);
    constexpr double rounding = 1e-15;
    const double most = std::sqrt(all.squares), area = std::sqrt(all.squared_area);
    const double root3 = std::sqrt(3.0);
    const double middle = root3 * area / most + rounding * most;
    return {most, middle, std::min(middle, root3 * (std::abs(all.volume) + all.rounding) / area)};
}

double flatness_over(double share, const Mat3& linear) {
    const Symmetric all(linear);
    if (all.in_range) {
        // sigma.z >= volume / area, and at most sqrt(3) times that; sigma.x is in such a range below
        // sqrt(squares).
        const double unit = std::sqrt(all.squared_area * all.squares);
        const double least = (std::abs(all.volume) - all.rounding) / unit;
        if (least > share) return least;
        if (3 * (std::abs(all.volume) + all.rounding) <= 0.99 * share * unit) return 0;
        // The volume of a line says nothing; the least value is no more than the middle one.
        const double middle = 3 * std::sqrt(all.squared_area) + 2e-15 * all.squares;
        if (middle <= 0.99 * share * all.squares) return 0;
    }
    const Vec3 sigma = singular_values(linear);
    return sigma.z > share * sigma.x ? sigma.z / sigma.x : 0;
}

std::optional<Affine> place_of_plane(const Affine& map) {
    const Vec3 normal = glm::cross(map.linear[2], map.linear[0]);
    const double area = glm::length(normal), x = glm::length(map.linear[0]), z = glm::length(map.linear[2]);
    if (!(area > flattest_plane * x * z) || !(std::min(x, z) > flattest_plane * std::max(x, z)))
        return std::nullopt;
    const Vec3 y_axis = normal / area, x_axis = map.linear[0] / x;
    return Affine{Mat3(x_axis, y_axis, glm::cross(x_axis, y_axis)), map.translation};
}

} // namespace graftal
