#include "runtime/export/formats/rigid_parts.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/support/jacobi.h"

namespace graftal {

namespace {

constexpr double right_angle = 1e-5;

/// Columns of unit length at right angles, the last as it must be for a turn; `lengths` says which columns
/// count. Those of no length are made up.
Mat3 turn_from(Mat3 columns, Vec3 lengths) {
    const double largest = std::max({lengths.x, lengths.y, lengths.z});
    std::array<bool, 3> counts{};
    for (int i = 0; i < 3; ++i) {
        counts[static_cast<std::size_t>(i)] = lengths[i] > 1e-12 * largest && lengths[i] > 0;
        if (counts[static_cast<std::size_t>(i)]) columns[i] /= lengths[i];
    }
    for (int i = 0; i < 3; ++i) {
        if (counts[static_cast<std::size_t>(i)]) continue;
        const int next = (i + 1) % 3, last = (i + 2) % 3;
        const bool has_next = counts[static_cast<std::size_t>(next)],
                   has_last = counts[static_cast<std::size_t>(last)];
        if (has_next && has_last) {
            columns[i] = glm::cross(columns[next], columns[last]);
        } else if (has_next || has_last) {
            const Vec3 known = columns[has_next ? next : last];
            const Vec3 other = std::abs(known.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
            columns[i] = glm::normalize(glm::cross(known, other));
        } else {
            columns[i] = Vec3(0.0);
            columns[i][i] = 1;
        }
        counts[static_cast<std::size_t>(i)] = true;
    }
    return columns;
}

} // namespace

std::optional<MoveTurnScale> move_turn_scale(const Affine& map) {
    const Mat3& m = map.linear;
    MoveTurnScale result;
    result.move = map.translation;
    result.scale = {glm::length(m[0]), glm::length(m[1]), glm::length(m[2])};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (std::abs(glm::dot(m[i], m[j])) > right_angle * result.scale[i] * result.scale[j])
            return std::nullopt;
    }
    Mat3 turn = turn_from(m, result.scale);
    if (glm::determinant(turn) < 0) {
        turn[2] = -turn[2];
        result.scale.z = -result.scale.z;
    }
    result.turn = glm::normalize(glm::quat_cast(turn));
    return result;
}

std::array<MoveTurnScale, 2> two_moves(const Affine& map) {
    const double size = largest_entry(map.linear);
    Mat3 stretched = size > 0 ? map.linear / size : map.linear, turn(1.0);
    make_columns_orthogonal(stretched, &turn); // map = stretched * transpose(turn)
    if (glm::determinant(turn) < 0) {
        turn[2] = -turn[2];
        stretched[2] = -stretched[2];
    }
    const Vec3 lengths(glm::length(stretched[0]), glm::length(stretched[1]), glm::length(stretched[2]));
    Mat3 outer = turn_from(stretched, lengths);
    MoveTurnScale first, second;
    first.move = map.translation;
    first.scale = size * lengths;
    if (glm::determinant(outer) < 0) {
        outer[2] = -outer[2];
        first.scale.z = -first.scale.z;
    }
    first.turn = glm::normalize(glm::quat_cast(outer));
    second.turn = glm::normalize(glm::quat_cast(glm::transpose(turn)));
    return {first, second};
}

} // namespace graftal
