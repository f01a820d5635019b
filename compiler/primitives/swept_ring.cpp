#include "compiler/primitives/swept_ring.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

Vec3 some_side(Vec3 along) {
    const Vec3 other = std::abs(along.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    return glm::normalize(glm::cross(along, other));
}

Vec3 moved_side(const SweptRing& from, const SweptRing& to) {
    const Vec3 way = to.centre - from.centre;
    const double length2 = glm::dot(way, way);
    Vec3 side = from.side, along = from.along;
    if (length2 > 0) {
        side -= 2 / length2 * glm::dot(way, side) * way;
        along -= 2 / length2 * glm::dot(way, along) * way;
    }
    const Vec3 turn = to.along - along;
    if (const double turn2 = glm::dot(turn, turn); turn2 > 0) side -= 2 / turn2 * glm::dot(turn, side) * turn;
    side -= glm::dot(side, to.along) * to.along;
    return glm::length(side) > 0 ? glm::normalize(side) : some_side(to.along);
}

} // namespace graftal
