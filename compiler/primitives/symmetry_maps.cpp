#include "compiler/primitives/symmetry_maps.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace graftal {

bool is_near_zero(const Mat3& m, double scale) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(m[column][row]) > symmetry_tolerance * scale) return false;
    return true;
}

bool is_orthogonal(const Mat3& m) {
    return is_near_zero(glm::transpose(m) * m - Mat3(1.0), 1);
}

bool turns_about_origin(const Affine& map) {
    return !(glm::length(map.translation) > symmetry_tolerance) && is_orthogonal(map.linear);
}

bool keeps_y_axis(const Mat3& m) {
    const auto is_zero = [](double x) { return std::abs(x) < symmetry_tolerance; };
    return is_zero(m[1][0]) && is_zero(m[1][2]) && is_zero(m[0][1]) && is_zero(m[2][1]);
}

} // namespace graftal
