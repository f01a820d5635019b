#include "compiler/lower/turtle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/support/number.h"

namespace graftal {

namespace {

/// `!` without an argument: the areas of two such branches sum to that of their parent.
constexpr double thinning = std::numbers::sqrt2 / 2;

constexpr Vec3 ahead(0, 1, 0);
constexpr Vec3 right(1, 0, 0);
constexpr Vec3 up(0, 0, 1);

double first_or(std::span<const double> parameters, double otherwise) {
    return parameters.empty() ? otherwise : parameters[0];
}

} // namespace

Turtle::Turtle(TurtleContext& context, const TurtleState& start) : context_(context), state_(start) {}

bool Turtle::run(TurtleCommand command, std::span<const double> parameters, std::optional<ObjectId> model,
                 Span span) {
    if (cut_depth_ > 0) return pass_over(command);
    ++part_.modules;
    const double angle_deg = first_or(parameters, context_.angle_deg);
    switch (command) {
    case TurtleCommand::none:
        return true;
    case TurtleCommand::draw:
        move(first_or(parameters, context_.step), true, true, span);
        break;
    case TurtleCommand::draw_unrecorded:
        move(first_or(parameters, context_.step), true, false, span);
        break;
    case TurtleCommand::move:
        move(first_or(parameters, context_.step), false, true, span);
        break;
    case TurtleCommand::move_unrecorded:
        move(first_or(parameters, context_.step), false, false, span);
        break;
    case TurtleCommand::turn_left:
        turn(up, angle_deg);
        return true;
    case TurtleCommand::turn_right:
        turn(up, -angle_deg);
        return true;
    case TurtleCommand::pitch_down:
        turn(right, -angle_deg);
        return true;
    case TurtleCommand::pitch_up:
        turn(right, angle_deg);
        return true;
    case TurtleCommand::roll_left:
        turn(ahead, -angle_deg);
        return true;
    case TurtleCommand::roll_right:
        turn(ahead, angle_deg);
        return true;
    case TurtleCommand::turn_back:
        turn(up, 180);
        return true;
    case TurtleCommand::level:
        level();
        return true;
    case TurtleCommand::width:
        return set_width(parameters, span);
    case TurtleCommand::colour_up:
        set_colour(parameters, 1);
        return true;
    case TurtleCommand::colour_down:
        set_colour(parameters, -1);
        return true;
    case TurtleCommand::tropism:
        state_.elasticity = first_or(parameters, 0);
        writes_ |= reads_elasticity;
        return true;
    case TurtleCommand::open_branch:
        open_branch();
        return true;
    case TurtleCommand::close_branch:
        close_branch();
        return true;
    case TurtleCommand::cut:
        cut();
        return true;
    case TurtleCommand::open_polygon:
        polygons_.emplace_back();
        return true;
    case TurtleCommand::close_polygon:
        close_polygon(span);
        break;
    case TurtleCommand::vertex:
        record_vertex();
        break;
    case TurtleCommand::sphere:
        part_.has_bodies = true;
        context_.bodies.add_sphere(start_from_turtle_, parameters.empty() ? read_width() : parameters[0],
                                   read_colour(), span, part_.instances);
        break;
    case TurtleCommand::disc:
        part_.has_bodies = true;
        context_.bodies.add_disc(start_from_turtle_, parameters.empty() ? read_width() : parameters[0],
                                 read_colour(), span, part_.instances);
        break;
    case TurtleCommand::model:
        part_.has_bodies = true;
        if (model)
            context_.bodies.add_model(*model, start_from_turtle_, first_or(parameters, 1), span, part_.instances);
        break;
    }
    return within_limits(span);
}

bool Turtle::pass_over(TurtleCommand command) {
    if (command == TurtleCommand::open_branch) {
        ++cut_depth_;
    } else if (command == TurtleCommand::close_branch && --cut_depth_ == 0) {
        ++part_.modules;
        close_branch();
    }
    return true;
}

bool Turtle::within_limits(Span span) {
    if (part_.instances.size() + vertex_count_ > context_.max_instances) {
        context_.diagnostics.error(
            span, fmt::format("more than {} parts are drawn in one place", context_.max_instances));
        return false;
    }
    if (is_finite(start_from_turtle_)) return true;
    context_.diagnostics.error(span, "the turtle goes farther than numbers reach")
        .with_hint("fewer steps, or a 'step' that shrinks with them, keep the model small");
    return false;
}

void Turtle::move(double length, bool draw, bool record, Span span) {
    const bool fills = !polygons_.empty() || (note(reads_polygon), state_.in_polygon);
    if (draw) ++part_.segments;
    if (draw && !fills)
        context_.bodies.add_segment(start_from_turtle_, length, line_width(length), read_colour(), span,
                                    part_.instances);
    start_from_turtle_ = start_from_turtle_ * Affine::translate(length * ahead);
    part_.reach = std::max(part_.reach, glm::length(start_from_turtle_.translation));
    for (auto [drift, total] : {std::pair(&error_, &part_.error), std::pair(&sensitivity_, &part_.sensitivity)}) {
        drift->shift += drift->turn * std::abs(length);
        total->farthest = std::max(total->farthest, drift->shift);
    }
    if (fills && record) record_vertex();
    if (draw) bend();
}

double Turtle::line_width(double length) {
    constexpr double slenderness = 0.05;
    return context_.limit && context_.lines ? slenderness * std::abs(length) : read_width();
}

void Turtle::turn(Vec3 axis, double angle_deg) {
    start_from_turtle_.linear = start_from_turtle_.linear * Affine::rotate(axis, angle_deg).linear;
}

/// L = V x H / |V x H|, U = H x L (ABOP, section 2.2); a turtle that heads straight up or down stays.
void Turtle::level() {
    note(reads_vertical);
    const Vec3 heading = start_from_turtle_.linear[1];
    const Vec3 left = glm::cross(state_.vertical, heading);
    constexpr double least_sine = 1e-9;
    if (!(glm::length(left) > least_sine)) return;
    // The roll turns about the heading by the angle that the vertical turns about it.
    sensitivity_.turn += (1 + sensitivity_.turn) / glm::length(left);
    const Vec3 x = -glm::normalize(left);
    start_from_turtle_.linear = Mat3(x, heading, glm::cross(x, heading));
}

/// Turns about H x T by the angle e |H x T| (ABOP, section 2.2), in radians.
void Turtle::bend() {
    note(reads_elasticity);
    if (state_.elasticity == 0) return;
    note(reads_tropism);
    const Vec3 axis = glm::cross(start_from_turtle_.linear[1], state_.tropism);
    const double sine = glm::length(axis);
    sensitivity_.turn += std::abs(state_.elasticity) * (1 + sensitivity_.turn);
    if (!(sine > 0)) return;
    const double angle_deg = state_.elasticity * sine * 180 / std::numbers::pi;
    start_from_turtle_.linear = Affine::rotate(axis, angle_deg).linear * start_from_turtle_.linear;
}

bool Turtle::set_width(std::span<const double> parameters, Span span) {
    const double width = parameters.empty() ? thinning * read_width() : parameters[0];
    if (width < 0) {
        context_.diagnostics.error(span, fmt::format("a width must not be negative, but is {}", shortest(width)));
        return false;
    }
    state_.width = width;
    writes_ |= reads_width;
    return true;
}

void Turtle::set_colour(std::span<const double> parameters, int step) {
    constexpr double most = 1e6;
    if (parameters.empty())
        state_.colour = read_colour() + step;
    else
        state_.colour = static_cast<int>(std::min(most, std::max(-most, std::floor(parameters[0]))));
    writes_ |= reads_colour;
}

/// With the rest of the branch go the ends of the polygons begun in it, and so the polygons.
void Turtle::cut() {
    cut_depth_ = 1;
    polygons_.resize(branches_.empty() ? 0 : branches_.back().polygons);
}

void Turtle::open_branch() {
    branches_.push_back({start_from_turtle_, state_, writes_, error_, sensitivity_, polygons_.size()});
}

void Turtle::close_branch() {
    if (branches_.empty()) return;
    start_from_turtle_ = branches_.back().start_from_turtle;
    state_ = branches_.back().state;
    writes_ = branches_.back().writes;
    error_ = branches_.back().error;
    sensitivity_ = branches_.back().sensitivity;
    branches_.pop_back();
}

void Turtle::record_vertex() {
    ++vertex_count_;
    if (!polygons_.empty()) {
        polygons_.back().push_back(start_from_turtle_.translation);
        return;
    }
    note(reads_polygon);
    if (state_.in_polygon) part_.vertices.push_back(start_from_turtle_.translation);
}

void Turtle::close_polygon(Span span) {
    if (polygons_.empty()) return;
    part_.has_bodies = true;
    context_.bodies.add_polygon(polygons_.back(), read_colour(), span, part_.instances);
    polygons_.pop_back();
}

TurtleState Turtle::state() const {
    TurtleState result = state_;
    const Mat3 turtle_from_start = glm::transpose(start_from_turtle_.linear);
    result.tropism = turtle_from_start * state_.tropism;
    result.vertical = turtle_from_start * state_.vertical;
    result.in_polygon = state_.in_polygon || !polygons_.empty();
    return result;
}

void Turtle::append(const TurtlePart& part, double snap) {
    append_branch(part, snap);
    const double length = glm::length(part.start_from_exit.translation);
    const double stir = 1 + sensitivity_.turn; // of the part's directions
    error_ = {error_.turn + part.error.exit_turn + snap * part.sensitivity.exit_turn,
              error_.at(length) + part.error.exit_shift + snap * part.sensitivity.exit_shift};
    sensitivity_ = {sensitivity_.turn + stir * part.sensitivity.exit_turn,
                    sensitivity_.at(length) + stir * part.sensitivity.exit_shift};
    if (part.writes & reads_width) state_.width = part.exit.width;
    if (part.writes & reads_colour) state_.colour = part.exit.colour;
    if (part.writes & reads_elasticity) state_.elasticity = part.exit.elasticity;
    writes_ |= part.writes;
    start_from_turtle_ = start_from_turtle_ * part.start_from_exit;
    if (part.cut) cut();
}

void Turtle::append_branch(const TurtlePart& part, double snap) {
    part_.error.farthest =
        std::max(part_.error.farthest, error_.at(part.reach) + part.error.farthest + snap * part.sensitivity.farthest);
    part_.sensitivity.farthest =
        std::max(part_.sensitivity.farthest,
                 sensitivity_.at(part.reach) + (1 + sensitivity_.turn) * part.sensitivity.farthest);
    TurtleStateMask reads = part.reads;
    // Whether a polygon is open outside of this part does not matter where one was opened inside.
    if (!polygons_.empty()) reads &= static_cast<TurtleStateMask>(~reads_polygon);
    note(reads);
    for (const Instance& instance : part.instances) {
        part_.instances.push_back(instance);
        part_.instances.back().parent_from_child = start_from_turtle_ * instance.parent_from_child;
    }
    for (const Vec3& vertex : part.vertices) {
        auto& vertices = polygons_.empty() ? part_.vertices : polygons_.back();
        vertices.push_back(start_from_turtle_(vertex));
    }
    vertex_count_ += part.vertices.size();
    part_.reach = std::max(part_.reach, glm::length(start_from_turtle_.translation) + part.reach);
    part_.has_bodies = part_.has_bodies || part.has_bodies;
    part_.modules += part.modules;
    part_.segments += part.segments;
}

TurtlePart Turtle::finish() && {
    part_.start_from_exit = start_from_turtle_;
    part_.exit = state_;
    part_.error = {error_.turn, error_.shift, part_.error.farthest};
    part_.sensitivity = {sensitivity_.turn, sensitivity_.shift, part_.sensitivity.farthest};
    part_.writes = writes_;
    part_.cut = cut_depth_ > 0;
    return std::move(part_);
}

} // namespace graftal
