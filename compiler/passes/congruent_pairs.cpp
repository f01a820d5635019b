#include "compiler/passes/congruent_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "compiler/primitives/symmetry_maps.h"

namespace graftal {

namespace {

std::vector<Mat3> signed_permutations() {
    std::vector<Mat3> all;
    std::array<int, 3> order = {0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Mat3 m(0.0);
            for (int column = 0; column < 3; ++column)
                m[column][order[column]] = (signs >> column & 1) ? -1.0 : 1.0;
            all.push_back(m);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
}

} // namespace

const std::vector<Mat3>& cube_symmetries() {
    static const std::vector<Mat3> all = signed_permutations();
    return all;
}

bool is_isometry(const Mat3& linear) {
    return is_orthogonal(linear);
}

bool takes_ellipsoid(const Affine& map, const Affine& from, const Affine& to) {
    const Affine moved = map * from;
    const Mat3 x = moved.linear * glm::transpose(moved.linear);
    const Mat3 y = to.linear * glm::transpose(to.linear);
    const double size = norm(y);
    return is_near_zero(x - y, 10 * size) &&
           glm::distance(moved.translation, to.translation) <= 1e-7 * std::sqrt(size);
}

} // namespace graftal
