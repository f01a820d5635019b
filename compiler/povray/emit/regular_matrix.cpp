#include "compiler/povray/emit/regular_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/support/jacobi.h"

namespace graftal {

namespace {

/// The least length of the shortest stretch where the longest is `longest`.
double least_stretch(double longest) {
    return std::max(1e-9, std::min(5e-4, 0.01 * longest));
}

/// Any unit vector at right angles to the unit vector u.
Vec3 some_perpendicular(Vec3 u) {
    const Vec3 axis = std::abs(u.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    return glm::normalize(glm::cross(u, axis));
}

/// a = sum of stretch[i] * to[i] * transpose(from[i]), with orthonormal to and from; longest stretch first.
struct Axes {
    std::array<Vec3, 3> from, to;
    std::array<double, 3> stretch;
};

Axes axes_of(Mat3 a) {
    Mat3 turn(1.0);
    make_columns_orthogonal(a, &turn);
    std::array<int, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(),
                     [&](int i, int j) { return glm::length(a[i]) > glm::length(a[j]); });
    Axes axes;
    for (std::size_t i = 0; i < 3; ++i) {
        axes.from[i] = turn[order[i]];
        axes.stretch[i] = glm::length(a[order[i]]);
        axes.to[i] = axes.stretch[i] > 0 ? a[order[i]] / axes.stretch[i] : Vec3(0.0);
    }
    // Directions of stretches that are rounding noise are completed at right angles to the others.
    const double noise = 1e-12 * axes.stretch[0];
    if (axes.stretch[0] == 0) axes.to[0] = {1, 0, 0};
    if (axes.stretch[1] <= noise) axes.to[1] = some_perpendicular(axes.to[0]);
    if (axes.stretch[2] <= noise) axes.to[2] = glm::cross(axes.to[0], axes.to[1]);
    return axes;
}

} // namespace

Affine regular(const Affine& a) {
    double squares = 0;
    for (int column = 0; column < 3; ++column)
        squares += glm::dot(a.linear[column], a.linear[column]);
    // The product of the two longer stretches is at most squares / 2, so this is a lower bound of the
    // shortest.
    const double shortest = squares > 0 ? std::abs(glm::determinant(a.linear)) / (0.5 * squares) : 0;
    if (shortest >= least_stretch(std::sqrt(squares))) return a;

    const Axes axes = axes_of(a.linear);
    const double least = least_stretch(axes.stretch[0]);
    if (axes.stretch[2] >= least) return a;
    Mat3 linear(0.0);
    for (std::size_t i = 0; i < 3; ++i)
        linear += std::max(axes.stretch[i], least) * glm::outerProduct(axes.to[i], axes.from[i]);
    return {linear, a.translation};
}

} // namespace graftal
