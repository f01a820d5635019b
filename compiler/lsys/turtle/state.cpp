#include "compiler/lsys/turtle/state.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace graftal {

namespace {

constexpr double same_rotation = 1e-11;

/// A hash with one number more, bit by bit.
std::uint64_t mixed_number(std::uint64_t hash, double number) {
    return mixed(hash, std::bit_cast<std::uint64_t>(number));
}

std::uint64_t mixed_vector(std::uint64_t hash, const Vec3& v) {
    return mixed_number(mixed_number(mixed_number(hash, v.x), v.y), v.z);
}

std::uint64_t hash_of_tropisms(std::uint64_t hash, const TurtleFrame& frame) {
    for (const Tropism& tropism : frame.tropisms)
        if (tropism.elasticity != 0)
            hash = mixed_vector(mixed_number(hash, tropism.elasticity), tropism.direction);
    return hash;
}

std::uint64_t hash_of_axes(std::uint64_t hash, const TurtleFrame& frame) {
    for (int column = 0; column < 3; ++column)
        hash = mixed_vector(hash, frame.axes[column]);
    return hash;
}

std::uint64_t hash_of_origin(std::uint64_t hash, const TurtleFrame& frame) {
    return mixed_number(mixed_vector(hash, frame.origin), frame.unit);
}

/// Elasticities, with the directions of those that are not 0.
bool equal_tropisms(const TurtleFrame& a, const TurtleFrame& b) {
    for (std::size_t i = 0; i < most_other_tropisms; ++i) {
        const Tropism &first = a.tropisms[i], &second = b.tropisms[i];
        if (first.elasticity != second.elasticity) return false;
        if (first.elasticity != 0 && first.direction != second.direction) return false;
    }
    return true;
}

/// Where the world is, and how large.
bool equal_places(const TurtleFrame& a, const TurtleFrame& b) {
    return a.origin == b.origin && a.unit == b.unit;
}

} // namespace

TurtleFrame seen_from(const TurtleFrame& frame, const Affine& start_from_turtle, double scale) {
    const Mat3 turtle_from_start = glm::transpose(start_from_turtle.linear);
    TurtleFrame seen = frame;
    seen.axes = turtle_from_start * frame.axes;
    seen.origin = (1 / scale) * (turtle_from_start * (frame.origin - start_from_turtle.translation));
    seen.unit = frame.unit / scale;
    for (Tropism& tropism : seen.tropisms)
        tropism.direction = turtle_from_start * tropism.direction;
    return seen;
}

TurtleState scaled(TurtleState state, double factor) {
    state.width *= factor;
    state.unit *= factor;
    state.control_point *= factor;
    state.control_width *= factor;
    state.limb_radius *= factor;
    if (state.frame) state.frame = std::make_shared<TurtleFrame>(seen_from(*state.frame, {}, 1 / factor));
    return state;
}

bool equal(const TurtleState& a, const TurtleState& b, TurtleStateMask mask) {
    return (!(mask & reads_width) || a.width == b.width) &&
           (!(mask & reads_tapers) || a.tapers == b.tapers) &&
           (!(mask & reads_colour) || a.colour == b.colour) &&
           (!(mask & reads_elasticity) || a.elasticity == b.elasticity) &&
           (!(mask & reads_tropism) || a.tropism == b.tropism) &&
           (!(mask & reads_vertical) || a.vertical == b.vertical) &&
           (!(mask & reads_polygons) || (a.open_polygons > 0) == (b.open_polygons > 0)) &&
           (!(mask & reads_polygon_count) || a.open_polygons == b.open_polygons) &&
           (!(mask & reads_variant) || a.variant == b.variant) &&
           (!(mask & reads_reversal) || a.turns_reversed == b.turns_reversed) &&
           (!(mask & reads_ruler) || a.ruler == b.ruler) &&
           (!(mask & reads_angle) || a.angle_factor == b.angle_factor) &&
           (!(mask & reads_second) || a.second == b.second) &&
           (!(mask & reads_birth) || a.birth == b.birth) && (!(mask & reads_unit) || a.unit == b.unit) &&
           (!(mask & reads_cylinder) || a.in_cylinder == b.in_cylinder) &&
           (!(mask & reads_limb) || a.limb_radius == b.limb_radius) &&
           (!(mask & reads_control) ||
            (a.control_point == b.control_point && a.control_width == b.control_width)) &&
           (!(mask & reads_tropisms) || equal_tropisms(*a.frame, *b.frame)) &&
           (!(mask & reads_axes) || a.frame->axes == b.frame->axes) &&
           (!(mask & reads_origin) || equal_places(*a.frame, *b.frame));
}

std::uint64_t hash(const TurtleState& state, TurtleStateMask mask) {
    std::uint64_t hash = mask;
    if (mask & reads_width) hash = mixed_number(hash, state.width);
    if (mask & reads_tapers) hash = mixed(hash, state.tapers);
    if (mask & reads_colour) hash = mixed(hash, static_cast<std::uint64_t>(state.colour));
    if (mask & reads_elasticity) hash = mixed_number(hash, state.elasticity);
    if (mask & reads_tropism) hash = mixed_vector(hash, state.tropism);
    if (mask & reads_vertical) hash = mixed_vector(hash, state.vertical);
    if (mask & reads_polygons) hash = mixed(hash, state.open_polygons > 0);
    if (mask & reads_polygon_count) hash = mixed(hash, state.open_polygons);
    if (mask & reads_variant) hash = mixed(hash, state.variant);
    if (mask & reads_birth) hash = mixed(hash, state.birth);
    if (mask & reads_unit) hash = mixed_number(hash, state.unit);
    if (mask & reads_reversal) hash = mixed(hash, state.turns_reversed);
    if (mask & reads_ruler) hash = mixed_number(hash, state.ruler);
    if (mask & reads_angle) hash = mixed_number(hash, state.angle_factor);
    if (mask & reads_second)
        hash = mixed_number(mixed_vector(hash, {state.second.x, state.second.y, state.second.z}),
                            state.second.w);
    if (mask & reads_cylinder) hash = mixed(hash, state.in_cylinder);
    if (mask & reads_limb) hash = mixed_number(hash, state.limb_radius);
    if (mask & reads_control)
        hash = mixed_number(mixed_vector(hash, state.control_point), state.control_width);
    if (mask & reads_tropisms) hash = hash_of_tropisms(hash, *state.frame);
    if (mask & reads_axes) hash = hash_of_axes(hash, *state.frame);
    if (mask & reads_origin) hash = hash_of_origin(hash, *state.frame);
    return hash;
}

Vec3 DirectionTable::representative(Vec3 direction) {
    const double cell_size = 4 * tolerance_;
    const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell_size)); };
    const auto hash_of = [](std::int64_t x, std::int64_t y, std::int64_t z) {
        return mixed(mixed(mixed(0, static_cast<std::uint64_t>(x)), static_cast<std::uint64_t>(y)),
                     static_cast<std::uint64_t>(z));
    };
    const auto same = [&](std::uint32_t id) { return glm::length(known_[id] - direction) <= tolerance_; };
    const Vec3 low = direction - tolerance_, high = direction + tolerance_;
    for (std::int64_t x = cell(low.x); x <= cell(high.x); ++x)
        for (std::int64_t y = cell(low.y); y <= cell(high.y); ++y)
            for (std::int64_t z = cell(low.z); z <= cell(high.z); ++z)
                if (const std::uint32_t id = ids_.find(hash_of(x, y, z), same); id != IdTable::none)
                    return known_[id];
    ids_.add(hash_of(cell(direction.x), cell(direction.y), cell(direction.z)),
             static_cast<std::uint32_t>(known_.size()));
    known_.push_back(direction + Vec3(0.0)); // no negative zeros
    return known_.back();
}

Mat3 RotationTable::representative(const Mat3& rotation) {
    const Vec3 y = glm::normalize(rotation[1]);
    const Vec3 x = glm::normalize(rotation[0] - glm::dot(rotation[0], y) * y);
    const Mat3 clean(x, y, glm::cross(x, y));
    // The cell of one number that depends on all entries in a way that no model favours: of two matrices
    // closer than the tolerance the cells are the same, or neighbours.
    const Mat3 weights(0.48273, 0.71931, 0.49942, 0.31177, -0.62935, 0.27061, -0.55821, 0.16943, 0.81219);
    double along = 0;
    for (int column = 0; column < 3; ++column)
        along += glm::dot(clean[column], weights[column]);
    const auto cell = static_cast<std::int64_t>(std::floor(along / (8 * same_rotation)));
    const auto same = [&](std::uint32_t id) {
        double gap = 0;
        for (int column = 0; column < 3; ++column)
            gap = std::max(gap, glm::length(known_[id][column] - clean[column]));
        return gap <= same_rotation;
    };
    for (const std::int64_t near : {cell, cell - 1, cell + 1}) {
        const std::uint32_t known = ids_.find(mixed(0, static_cast<std::uint64_t>(near)), same);
        if (known != IdTable::none) return known_[known];
    }
    ids_.add(mixed(0, static_cast<std::uint64_t>(cell)), static_cast<std::uint32_t>(known_.size()));
    known_.push_back(clean);
    return known_.back();
}

Quat RotationTable::representative(const Quat& rotation) {
    const Quat same = glm::quat_cast(representative(glm::mat3_cast(rotation)));
    return same + Quat(0, 0, 0, 0); // no negative zeros
}

} // namespace graftal
