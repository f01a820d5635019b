#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/lsys/turtle.h"
#include "compiler/support/angle.h"

// Where a turtle heads.

namespace graftal {

double Turtle::sense() {
    if (!context_.reverses_turns) return 1;
    note(reads_reversal);
    return state_.turns_reversed ? -1 : 1;
}

/// With a parameter, so that turns are reversed where it is not 0; without, the other way than before.
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

/// By columns: what is not turned stays as it is, to the last bit.
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
    if (state_.elasticity == 0) return;
    note(reads_tropism);
    const Vec3 axis = glm::cross(start_from_turtle_.linear[1], state_.tropism);
    const double sine = glm::length(axis);
    sensitivity_.turn = bounded(sensitivity_.turn + std::abs(state_.elasticity) * (1 + sensitivity_.turn));
    if (!(sine > 0)) return;
    const double angle_deg = state_.elasticity * sine * 180 / std::numbers::pi;
    start_from_turtle_.linear = Affine::rotate(axis, angle_deg).linear * start_from_turtle_.linear;
}

/// By e |H x V|, in radians, about the turtle's own axis: so L-Parser bends branches.
void Turtle::bend_down(double elasticity) {
    note(reads_vertical);
    const double sine = glm::length(glm::cross(start_from_turtle_.linear[1], state_.vertical));
    sensitivity_.turn = bounded(sensitivity_.turn + std::abs(elasticity) * (1 + sensitivity_.turn));
    turn(Axis::right, -elasticity * sine * 180 / std::numbers::pi);
}

} // namespace graftal
