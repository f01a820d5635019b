#include "compiler/support/jacobi.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace graftal {

void make_columns_orthogonal(Mat3& a, Mat3* turn) {
    constexpr int enough_sweeps = 6;
    for (int sweep = 0; sweep < 30; ++sweep) {
        bool rotated = false;
        for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
            const double alpha = glm::dot(a[p], a[p]);
            const double beta = glm::dot(a[q], a[q]);
            const double gamma = glm::dot(a[p], a[q]);
            if (std::abs(gamma) <= 1e-16 * std::sqrt(alpha * beta) || gamma == 0) continue;
            // A column that a singular map leaves as rounding noise never comes to be at right angles.
            if (sweep >= enough_sweeps && std::min(alpha, beta) < 1e-30 * std::max(alpha, beta)) continue;
            rotated = true;
            const double zeta = (beta - alpha) / (2 * gamma);
            const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
            const double c = 1 / std::sqrt(1 + t * t);
            const auto rotate = [&](Mat3& m) {
                const Vec3 column = m[p];
                m[p] = c * column - c * t * m[q];
                m[q] = c * t * column + c * m[q];
            };
            rotate(a);
            if (turn) rotate(*turn);
        }
        if (!rotated) break;
    }
}

} // namespace graftal
