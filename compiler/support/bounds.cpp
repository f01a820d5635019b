#include "compiler/support/bounds.h"

#include <glm/common.hpp>

namespace graftal {

void Box::include(Vec3 point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
}

void Box::include(const Box& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
}

std::array<Vec3, 8> Box::corners() const {
    std::array<Vec3, 8> corners;
    for (int i = 0; i < 8; ++i)
        corners[i] = {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z};
    return corners;
}

Box transformed(const Affine& a, const Box& box) {
    if (box.empty()) return {};
    const Vec3 half = 0.5 * box.size();
    Vec3 reach(0.0);
    for (int column = 0; column < 3; ++column)
        reach += glm::abs(a.linear[column]) * half[column];
    const Vec3 centre = a(box.centre());
    return {centre - reach, centre + reach};
}

Ball transformed(const Affine& a, const Ball& ball) {
    if (ball.empty()) return {};
    return {a(ball.centre), norm(a.linear) * ball.radius};
}

} // namespace graftal
