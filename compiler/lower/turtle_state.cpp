#include "compiler/lower/turtle_state.h"

#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr double same_direction = 1e-11;

std::uint64_t mixed_number(std::uint64_t hash, double number) {
    return mixed(hash, std::bit_cast<std::uint64_t>(number));
}

std::uint64_t mixed_vector(std::uint64_t hash, const Vec3& v) {
    return mixed_number(mixed_number(mixed_number(hash, v.x), v.y), v.z);
}

} // namespace

bool equal(const TurtleState& a, const TurtleState& b, TurtleStateMask mask) {
    return (!(mask & reads_width) || a.width == b.width) && (!(mask & reads_colour) || a.colour == b.colour) &&
           (!(mask & reads_elasticity) || a.elasticity == b.elasticity) &&
           (!(mask & reads_tropism) || a.tropism == b.tropism) &&
           (!(mask & reads_vertical) || a.vertical == b.vertical) &&
           (!(mask & reads_polygon) || a.in_polygon == b.in_polygon) &&
           (!(mask & reads_variant) || a.variant == b.variant);
}

std::uint64_t hash(const TurtleState& state, TurtleStateMask mask) {
    std::uint64_t hash = mask;
    if (mask & reads_width) hash = mixed_number(hash, state.width);
    if (mask & reads_colour) hash = mixed(hash, static_cast<std::uint64_t>(state.colour));
    if (mask & reads_elasticity) hash = mixed_number(hash, state.elasticity);
    if (mask & reads_tropism) hash = mixed_vector(hash, state.tropism);
    if (mask & reads_vertical) hash = mixed_vector(hash, state.vertical);
    if (mask & reads_polygon) hash = mixed(hash, state.in_polygon);
    if (mask & reads_variant) hash = mixed(hash, state.variant);
    return hash;
}

Vec3 DirectionTable::representative(Vec3 direction) {
    // The cell of one coordinate along an axis that no model favours; two directions closer than the
    // tolerance lie in the same cell or in neighbours.
    const double along = glm::dot(direction, Vec3(0.48273, 0.71931, 0.49942));
    const auto cell = static_cast<std::int64_t>(std::floor(along / (4 * same_direction)));
    const auto same = [&](std::uint32_t id) { return glm::length(directions_[id] - direction) <= same_direction; };
    for (const std::int64_t near : {cell, cell - 1, cell + 1}) {
        const std::uint32_t known = ids_.find(mixed(0, static_cast<std::uint64_t>(near)), same);
        if (known != IdTable::none) return directions_[known];
    }
    ids_.find_or_add(mixed(0, static_cast<std::uint64_t>(cell)), static_cast<std::uint32_t>(directions_.size()),
                     [](std::uint32_t) { return false; });
    directions_.push_back(direction + Vec3(0.0)); // no negative zeros
    return directions_.back();
}

} // namespace graftal
