#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/lsys/turtle/turtle.h"
#include "compiler/support/angle.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

// Where a turtle heads.

namespace graftal {

double Turtle::sense() {
    if (!context_.reverses_turns) return 1;
    note(reads_reversal);
    return state_.turns_reversed ? -1 : 1;
}

/// Reverses turns if the parameter is not 0, else not; without one, the other way than before.
void Turtle::reverse_turns(std::span<const double> parameters) {
    if (parameters.empty()) note(reads_reversal);
    state_.turns_reversed = parameters.empty() ? !state_.turns_reversed : parameters[0] != 0;
    writes_ |= reads_reversal;
}

void Turtle::exchange() {
    note(reads_second);
    std::swap(start_from_turtle_.linear, second_);
    writes_ |= reads_second;
}

/// Both pairs of axes become mirror images, so that the second ones are seen from the first as before.
void Turtle::flip() {
    start_from_turtle_.linear[0] = -start_from_turtle_.linear[0];
    second_[0] = -second_[0];
    mirrored_ = !mirrored_;
}

/// Turns column by column: a column that is not turned stays as it is, to the last bit.
void Turtle::turn(Axis axis, double angle_deg) {
    const auto [cosine, sine] = cos_sin_deg(angle_deg);
    const int k = static_cast<int>(axis);
    Vec3& first = start_from_turtle_.linear[(k + 1) % 3];
    Vec3& second = start_from_turtle_.linear[(k + 2) % 3];
    const Vec3 turned = cosine * first + sine * second;
    second = cosine * second - sine * first;
    first = turned;
}

/// L = V x H / |V x H|, U = H x L (ABOP, section 2.2); a turtle that heads straight up or down stays.
void Turtle::level() {
    note(reads_vertical);
    const Vec3 heading = start_from_turtle_.linear[1];
    const Vec3 left = glm::cross(state_.vertical, heading);
    constexpr double least_sine = 1e-9;
    if (!(glm::length(left) > least_sine)) return;
    // The roll turns about the heading by the angle that the vertical turns about it.
    sensitivity_.turn = bounded(sensitivity_.turn + (1 + sensitivity_.turn) / glm::length(left));
    const Vec3 x = -glm::normalize(left);
    start_from_turtle_.linear = Mat3(mirrored_ ? -x : x, heading, glm::cross(x, heading));
}

/// Turns about H x T by the angle e |H x T| (ABOP, section 2.2), in radians.
void Turtle::bend() {
    note(reads_elasticity);
    if (!context_.tropisms.empty()) return bend_to_all();
    if (state_.elasticity == 0) return;
    note(reads_tropism);
    const Vec3 axis = glm::cross(start_from_turtle_.linear[1], state_.tropism);
    const double sine = glm::length(axis);
    sensitivity_.turn = bounded(sensitivity_.turn + std::abs(state_.elasticity) * (1 + sensitivity_.turn));
    if (!(sine > 0)) return;
    const double angle_deg = state_.elasticity * sine * 180 / std::numbers::pi;
    start_from_turtle_.linear = Affine::rotate(axis, angle_deg).linear * start_from_turtle_.linear;
}

/// Bends by the sum of the pulls of all tropisms. One at an angle g to its direction T pulls with e (T cos g
/// + P sin g). P is the direction of the heading's part across T. Tropisms that twist do so after that.
void Turtle::bend_to_all() {
    note(reads_tropisms);
    if (state_.elasticity != 0) note(reads_tropism);
    const Vec3 heading = start_from_turtle_.linear[1];
    Vec3 pull(0.0), twist(0.0);
    double elasticity = 0;
    for (std::size_t i = 0; i < context_.tropisms.size(); ++i) {
        const Tropism own =
            i == 0 ? Tropism{state_.tropism, state_.elasticity} : state_.frame->tropisms[i - 1];
        const TropismKind& kind = context_.tropisms[i];
        elasticity += std::abs(own.elasticity);
        if (kind.twists) twist += own.elasticity * own.direction;
        if (own.elasticity == 0 || kind.twists) continue;
        pull += own.elasticity * kind.toward * own.direction;
        const Vec3 part = heading - glm::dot(heading, own.direction) * own.direction;
        constexpr double least_part = 1e-7;
        const double length = glm::length(part);
        if (kind.across != 0 && length > least_part) pull += (own.elasticity * kind.across / length) * part;
        // One that heads along the direction leaves it to its right.
        if (kind.across != 0 && length <= least_part)
            pull += own.elasticity * kind.across * start_from_turtle_.linear[0];
    }
    sensitivity_.turn = bounded(sensitivity_.turn + 2 * elasticity * (1 + sensitivity_.turn));
    const Vec3 axis = glm::cross(heading, pull);
    const double sine = glm::length(axis);
    if (sine > 0)
        start_from_turtle_.linear =
            Affine::rotate(axis, sine * 180 / std::numbers::pi).linear * start_from_turtle_.linear;
    if (glm::length(twist) > 0) twist_to(twist);
}

/// Turns z towards the part of `pull` across the heading, that part taken as long as `pull` is, by |z x P|
/// radians.
void Turtle::twist_to(Vec3 pull) {
    const Vec3 heading = start_from_turtle_.linear[1];
    const Vec3 part = pull - glm::dot(pull, heading) * heading;
    constexpr double least_sine = 1e-4;
    if (!(glm::length(part) > least_sine * glm::length(pull))) return;
    const Vec3 axis = glm::cross(start_from_turtle_.linear[2], part);
    const double angle = std::min(1.0, glm::length(axis));
    if (!(angle > 0)) return;
    start_from_turtle_.linear =
        Affine::rotate(axis, angle * 180 / std::numbers::pi).linear * start_from_turtle_.linear;
    start_from_turtle_.linear[1] = heading;
}

bool Turtle::set_tropism(std::span<const double> parameters, Span span) {
    const double number = parameters.empty() ? 1 : std::floor(parameters[0]);
    const double elasticity = parameters.size() < 2 ? 0 : parameters[1];
    const std::size_t count = std::max<std::size_t>(1, context_.tropisms.size());
    if (!(number >= 1 && number <= static_cast<double>(count))) {
        context_.diagnostics
            .error(span, fmt::format("there is no tropism {}: the block has {}", shortest(number), count))
            .with_hint("write a 'tropism' or a 'torque' for each");
        return false;
    }
    if (!(std::abs(elasticity) <= largest_size)) {
        context_.diagnostics.error(span, fmt::format("an elasticity is at most {}", shortest(largest_size)));
        return false;
    }
    if (number == 1) {
        state_.elasticity = elasticity;
        writes_ |= reads_elasticity;
        return true;
    }
    note(reads_tropisms); // tropisms that stay
    writes_ |= reads_tropisms;
    TurtleFrame frame = *state_.frame;
    frame.tropisms[static_cast<std::size_t>(number) - 2].elasticity = elasticity;
    state_.frame = std::make_shared<TurtleFrame>(frame);
    return true;
}

/// A place of the world: x, y, z.
void Turtle::go_to(std::span<const double> parameters) {
    note(reads_origin | reads_axes);
    Vec3 place(0.0);
    for (std::size_t i = 0; i < std::min<std::size_t>(3, parameters.size()); ++i)
        place[static_cast<int>(i)] = parameters[i];
    const Vec3 before = start_from_turtle_.translation;
    start_from_turtle_.translation = state_.frame->origin + state_.frame->unit * (state_.frame->axes * place);
    part_.reach = std::max(part_.reach, glm::length(start_from_turtle_.translation));
    way_ += glm::length(start_from_turtle_.translation - before);
    if (context_.skin > 0) set_limb_radius(0);
    part_.longest_way = std::max(part_.longest_way, way_);
}

/// A direction of the world, and, if it is given, the one that z shall be near.
bool Turtle::head_to(std::span<const double> parameters, Span span) {
    note(reads_axes);
    const auto direction = [&](std::size_t first) {
        Vec3 of_world(0.0);
        for (std::size_t i = 0; i < 3 && first + i < parameters.size(); ++i)
            of_world[static_cast<int>(i)] = parameters[first + i];
        return state_.frame->axes * of_world;
    };
    const Vec3 heading = direction(0);
    if (!(glm::length(heading) > 0) || !std::isfinite(glm::length(heading))) {
        context_.diagnostics.error(span, "'@R' needs a direction: x, y, z that are not all 0");
        return false;
    }
    turn_to(glm::normalize(heading));
    const Vec3 ahead = start_from_turtle_.linear[1];
    const Vec3 above = direction(3);
    const Vec3 up = above - glm::dot(above, ahead) * ahead;
    constexpr double least_sine = 1e-9;
    if (!(glm::length(up) > least_sine * glm::length(above))) return true;
    const Vec3 z = glm::normalize(up), x = glm::cross(ahead, z);
    start_from_turtle_.linear = Mat3(mirrored_ ? -x : x, ahead, z);
    return true;
}

/// Turns by the smallest rotation to the heading; backwards, about z.
void Turtle::turn_to(Vec3 heading) {
    const Vec3 ahead = start_from_turtle_.linear[1];
    const Vec3 axis = glm::cross(ahead, heading);
    const double sine = glm::length(axis), cosine = glm::dot(ahead, heading);
    constexpr double least_sine = 1e-12;
    if (sine > least_sine)
        start_from_turtle_.linear =
            Affine::rotate(axis, std::atan2(sine, cosine) * 180 / std::numbers::pi).linear *
            start_from_turtle_.linear;
    else if (cosine < 0)
        turn(Axis::up, 180);
    start_from_turtle_.linear[1] = heading;
}

/// Bends by e |H x V|, in radians, about the turtle's own axis: so L-Parser bends branches.
void Turtle::bend_down(double elasticity) {
    note(reads_vertical);
    const double sine = glm::length(glm::cross(start_from_turtle_.linear[1], state_.vertical));
    sensitivity_.turn = bounded(sensitivity_.turn + std::abs(elasticity) * (1 + sensitivity_.turn));
    turn(Axis::right, -elasticity * sine * 180 / std::numbers::pi);
}

} // namespace graftal
