#include "compiler/lsys/turtle/turtle.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "compiler/lsys/turtle/polygon_outline.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

/// Polygons are cut into triangles in a time that grows with the square of this.
constexpr std::size_t max_polygon_vertices = 10'000;
/// Parts keep the vertices of those that they leave open.
constexpr std::size_t max_polygon_nesting = 1000;

double first_or(std::span<const double> parameters, double otherwise) {
    return parameters.empty() ? otherwise : parameters[0];
}

/// The name of a command's first parameter, where that must stay in the range of numbers.
const char* size_name(TurtleCommand command) {
    switch (command) {
    case TurtleCommand::draw:
    case TurtleCommand::draw_unrecorded:
    case TurtleCommand::draw_always:
    case TurtleCommand::move:
    case TurtleCommand::move_unrecorded:
        return "a length";
    case TurtleCommand::width:
    case TurtleCommand::widen:
        return "a width";
    case TurtleCommand::sphere:
    case TurtleCommand::disc:
        return "a diameter";
    case TurtleCommand::tropism:
    case TurtleCommand::stiffen:
    case TurtleCommand::bend_down:
        return "an elasticity";
    case TurtleCommand::scale_by:
    case TurtleCommand::scale_down_by:
    case TurtleCommand::step_by:
    case TurtleCommand::width_by:
    case TurtleCommand::angle_by:
        return "a factor";
    default:
        return nullptr;
    }
}

} // namespace

Turtle::Turtle(TurtleContext& context, const TurtleState& start)
    : context_(context), second_(glm::mat3_cast(start.second)), state_(start) {}

bool Turtle::run(TurtleCommand command, std::span<const double> parameters,
                 const std::optional<PlacedModel>& model, Span span, bool absolute) {
    if (cut_depth_ > 0) return pass_over(command);
    ++modules_;
    if (absolute) note(reads_unit);
    if (!in_range(command, parameters, model, span)) return false;
    const auto angle_deg = [&] { return parameters.empty() ? usual_angle() : parameters[0]; };
    switch (command) {
    case TurtleCommand::none:
        return true;
    case TurtleCommand::draw:
        move(parameters, absolute, true, true, span);
        break;
    case TurtleCommand::draw_always:
        move(parameters, absolute, true, false, span, true);
        break;
    case TurtleCommand::draw_unrecorded:
        move(parameters, absolute, true, false, span);
        break;
    case TurtleCommand::move:
        move(parameters, absolute, false, true, span);
        break;
    case TurtleCommand::move_unrecorded:
        move(parameters, absolute, false, false, span);
        break;
    case TurtleCommand::turn_left:
        turn(Axis::up, sense() * angle_deg());
        return true;
    case TurtleCommand::turn_right:
        turn(Axis::up, -sense() * angle_deg());
        return true;
    case TurtleCommand::pitch_down:
        turn(Axis::right, -angle_deg());
        return true;
    case TurtleCommand::pitch_up:
        turn(Axis::right, angle_deg());
        return true;
    case TurtleCommand::roll_left:
        turn(Axis::ahead, -angle_deg());
        return true;
    case TurtleCommand::roll_right:
        turn(Axis::ahead, angle_deg());
        return true;
    case TurtleCommand::turn_back:
        turn(Axis::up, 180);
        return true;
    case TurtleCommand::level:
        level();
        return true;
    case TurtleCommand::width:
        return set_width(parameters, absolute, span);
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
        polygons_.push_back({start_from_turtle_.linear, {}});
        break;
    case TurtleCommand::close_polygon:
        close_polygon(read_colour(), span);
        break;
    case TurtleCommand::vertex:
        record_vertex(start_from_turtle_.translation);
        break;
    case TurtleCommand::start_cylinder:
        start_cylinder();
        return true;
    case TurtleCommand::control_point:
        add_control_point(span);
        break;
    case TurtleCommand::end_cylinder:
        add_control_point(span);
        state_.in_cylinder = false;
        writes_ |= reads_cylinder;
        break;
    case TurtleCommand::sphere:
    case TurtleCommand::disc:
        add_ball(command, parameters, absolute, span);
        break;
    case TurtleCommand::scale_by:
        return scale_by(first_or(parameters, 1), true, span);
    case TurtleCommand::scale_down_by:
        return scale_by(1 / first_or(parameters, 1), true, span);
    case TurtleCommand::step_by:
        return scale_by(first_or(parameters, 1), false, span);
    case TurtleCommand::bend_down:
        bend_down(first_or(parameters, 0));
        return true;
    case TurtleCommand::width_by:
        return widen_by(first_or(parameters, 1), span);
    case TurtleCommand::angle_by:
        return multiply_angle(first_or(parameters, 1), span);
    case TurtleCommand::reverse_turns:
        reverse_turns(parameters);
        return true;
    case TurtleCommand::exchange:
        exchange();
        return true;
    case TurtleCommand::flip:
        flip();
        return true;
    case TurtleCommand::widen:
        return widen(first_or(parameters, 0), span);
    case TurtleCommand::stiffen:
        note(reads_elasticity);
        state_.elasticity += first_or(parameters, 0);
        writes_ |= reads_elasticity;
        return true;
    case TurtleCommand::set_tropism:
        return set_tropism(parameters, span);
    case TurtleCommand::go_to:
        go_to(parameters);
        break;
    case TurtleCommand::head_to:
        return head_to(parameters, span);
    case TurtleCommand::ask_place:
    case TurtleCommand::ask_heading:
    case TurtleCommand::ask_up:
    case TurtleCommand::ask_left:
    case TurtleCommand::ask_environment:
        return true;
    case TurtleCommand::model:
        if (model) add_model(*model, absolute, span);
        break;
    }
    return within_limits(span);
}

bool Turtle::in_range(TurtleCommand command, std::span<const double> parameters,
                      const std::optional<PlacedModel>& model, Span span) {
    const char* name = size_name(command);
    double size = name && !parameters.empty() ? parameters[0] : 0;
    if (command == TurtleCommand::model && model) {
        name = "the scale of a model";
        size = largest_entry(model->scale);
    }
    if (std::abs(size) <= largest_size) return true;
    context_.diagnostics
        .error(span, fmt::format("{} is at most {}, not {}", name, shortest(largest_size),
                                 std::isfinite(size) ? shortest(size) : "an infinite one"))
        .with_hint("use smaller factors or fewer steps to keep the model within the range of numbers");
    return false;
}

bool Turtle::pass_over(TurtleCommand command) {
    if (command == TurtleCommand::open_branch) {
        ++cut_depth_;
    } else if (command == TurtleCommand::close_branch && --cut_depth_ == 0) {
        ++modules_;
        close_branch();
    }
    return true;
}

bool Turtle::within_limits(Span span) {
    if (part_.instances.size() + vertex_count_ > context_.max_instances) {
        context_.diagnostics.error(
            span, fmt::format("the model draws more than {} parts in one place", context_.max_instances));
        return false;
    }
    if (context_.bodies.packed_count() > max_packed_items) {
        context_.diagnostics
            .error(span, fmt::format("the model draws more than {} single parts", max_packed_items))
            .with_hint("use fewer steps to draw fewer parts");
        return false;
    }
    if (context_.bodies.skin_triangles() > most_skin_triangles) {
        context_.diagnostics
            .error(span, fmt::format("the skin of the limbs has more than {} triangles", most_skin_triangles))
            .with_hint("give 'skin' a larger tolerance, or use fewer steps");
        return false;
    }
    if (longest_polygon_ > max_polygon_vertices) {
        context_.diagnostics.error(span,
                                   fmt::format("a polygon has more than {} vertices", max_polygon_vertices));
        return false;
    }
    if (state_.open_polygons + polygons_.size() > max_polygon_nesting) {
        context_.diagnostics.error(
            span, fmt::format("more than {} polygons are open in one place", max_polygon_nesting));
        return false;
    }
    if (!is_size(scale_)) return report_scale(span); // parts multiply it, too
    const Vec3 place = glm::abs(start_from_turtle_.translation);
    if (place.x <= largest_size && place.y <= largest_size && place.z <= largest_size) return true;
    context_.diagnostics.error(span, "the turtle goes beyond the range of numbers")
        .with_hint("use fewer steps, or a 'step' that shrinks with them, to keep the model small");
    return false;
}

void Turtle::move(std::span<const double> parameters, bool absolute, bool draw, bool record, Span span,
                  bool always) {
    absolute = absolute || parameters.empty();
    if (context_.bending == Bending::before_moves) bend();
    const double length =
        at_least_size(parameters.empty() ? scale_ * context_.step * read_unit() : written(parameters[0]));
    const bool fills = !always && (!polygons_.empty() || (note(reads_polygons), state_.open_polygons > 0));
    if (draw) ++segments_;
    if (absolute) unit_shift_ += std::abs(length);
    if (draw && context_.draws && !fills && !(note(reads_cylinder), state_.in_cylinder)) {
        const double width = line_width(length);
        if (context_.skin > 0)
            add_segment_to_limb(length, width, span);
        else
            context_.bodies.add_segment(start_from_turtle_, length, width, read_colour(), span, sink(true));
        note_radius(width / 2, width_source_);
        if (context_.tallies && length != 0) part_.lengths.add(std::abs(length));
    } else if (context_.skin > 0 && length != 0 && !(note(reads_cylinder), state_.in_cylinder)) {
        set_limb_radius(0);
    }
    part_.unit_sensitivity.farthest = std::max(part_.unit_sensitivity.farthest, unit_shift_);
    start_from_turtle_.translation += length * start_from_turtle_.linear[1];
    part_.reach = std::max(part_.reach, glm::length(start_from_turtle_.translation));
    way_ += std::abs(length);
    part_.longest_way = std::max(part_.longest_way, way_);
    for (auto [drift, total] :
         {std::pair(&error_, &part_.error), std::pair(&sensitivity_, &part_.sensitivity)}) {
        drift->shift = bounded(drift->shift + drift->turn * std::abs(length));
        total->farthest = std::max(total->farthest, drift->shift);
    }
    if (fills && record) record_vertex(start_from_turtle_.translation);
    if (context_.bending == Bending::after_moves || (draw && context_.bending == Bending::after_segments))
        bend();
}

void Turtle::add_ball(TurtleCommand command, std::span<const double> parameters, bool absolute, Span span) {
    if (!context_.draws) return;
    part_.has_bodies = true;
    ++bodies_;
    const double diameter = parameters.empty() ? usual_diameter() : written(parameters[0]);
    if (command == TurtleCommand::sphere)
        context_.bodies.add_sphere(start_from_turtle_, diameter, read_colour(), span,
                                   sink(parameters.empty()));
    else
        context_.bodies.add_disc(start_from_turtle_, diameter, read_colour(), span, sink(parameters.empty()));
    if (parameters.empty())
        note_radius(diameter / 2, width_source_);
    else
        note_radius(std::abs(diameter) / 2, absolute ? WidthSource::unit : WidthSource::sizes);
}

void Turtle::add_model(const PlacedModel& model, bool absolute, Span span) {
    if (!context_.draws) return;
    part_.has_bodies = true;
    ++bodies_;
    PlacedModel placed = model;
    placed.scale *= written(1);
    context_.bodies.add_model(placed, start_from_turtle_, span, sink(false));
    // Points of primitives lie no farther from their origin; with others the unit is never off.
    constexpr double farthest = 2;
    if (absolute) note_radius(farthest * largest_entry(placed.scale), WidthSource::unit);
}

void Turtle::set_colour(std::span<const double> parameters, int step) {
    const double number = parameters.empty() ? read_colour() + step : std::floor(parameters[0]);
    state_.colour = context_.bodies.colour_index(number);
    writes_ |= reads_colour;
}

/// Cuts the rest of the branch, with the ends of the polygons begun in it, and so these polygons.
void Turtle::cut() {
    cut_depth_ = 1;
    const std::size_t before = branches_.empty() ? 0 : branches_.back().polygons;
    if (polygons_.size() > before) polygons_.resize(before);
}

void Turtle::open_branch() {
    branches_.push_back({start_from_turtle_, state_, writes_, error_, sensitivity_, way_, size_shift_,
                         unit_shift_, width_error_, scale_, second_, mirrored_, width_source_,
                         polygons_.size(), context_.skin > 0 ? branch_off() : Limb()});
    if (context_.taper < 1) taper();
}

void Turtle::close_branch() {
    if (branches_.empty()) return;
    if (context_.skin > 0) {
        end_limb();
        limb_ = std::move(branches_.back().limb);
    }
    start_from_turtle_ = branches_.back().start_from_turtle;
    const std::uint32_t open_polygons = state_.open_polygons; // no branch closes or opens them again
    state_ = branches_.back().state;
    state_.open_polygons = open_polygons;
    writes_ = branches_.back().writes;
    error_ = branches_.back().error;
    sensitivity_ = branches_.back().sensitivity;
    way_ = branches_.back().way;
    size_shift_ = branches_.back().size_shift;
    unit_shift_ = branches_.back().unit_shift;
    width_error_ = branches_.back().width_error;
    scale_ = branches_.back().scale;
    second_ = branches_.back().second;
    mirrored_ = branches_.back().mirrored;
    width_source_ = branches_.back().width_source;
    branches_.pop_back();
}

void Turtle::record_vertex(Vec3 vertex) {
    ++vertex_count_;
    const bool here = !polygons_.empty();
    if (!here) note(reads_polygons);
    if (!here && state_.open_polygons == 0) return;
    std::vector<Vec3>& vertices = here ? polygons_.back().vertices : part_.vertices;
    vertices.push_back(vertex);
    longest_polygon_ = std::max(longest_polygon_, vertices.size());
}

/// A '}' that closes nothing is passed over.
void Turtle::close_polygon(int colour, Span span) {
    if (!polygons_.empty()) {
        if (context_.draws) {
            part_.has_bodies = true;
            ++bodies_;
            const auto& [axes, vertices] = polygons_.back();
            // A word that is drawn again says nothing again.
            const auto is_known = [&](const Diagnostic& known) { return known.span == span; };
            if (!context_.bodies.add_polygon(vertices, axes, colour, span, sink(false)) &&
                std::ranges::none_of(context_.diagnostics.all(), is_known))
                context_.diagnostics
                    .warning(span, "the picture covers each triangle of this polygon by itself")
                    .with_hint(fmt::format("it covers a polygon once that is flat, does not meet itself and "
                                           "has at most {} vertices; the model's different ones have {} "
                                           "vertices at most",
                                           most_outline_corners, most_picture_corners));
        }
        polygons_.pop_back();
        return;
    }
    note(reads_polygon_count);
    if (state_.open_polygons == 0) return;
    --state_.open_polygons;
    part_.polygon_ends.push_back({std::exchange(part_.vertices, {}), colour});
}

void Turtle::start_cylinder() {
    state_.in_cylinder = true;
    state_.control_point = start_from_turtle_.translation;
    state_.control_width = usual_diameter();
    writes_ |= reads_cylinder | reads_control;
    if (context_.skin > 0) set_limb_radius(state_.control_width / 2);
}

/// Adds a control point, or the end: draws the piece of the cylinder that reaches to here.
void Turtle::add_control_point(Span span) {
    note(reads_cylinder);
    if (!state_.in_cylinder) return;
    note(reads_control);
    if (!context_.draws) return start_cylinder();
    const double width = usual_diameter();
    const LimbNode from{state_.control_point, state_.control_width / 2};
    const LimbNode to{start_from_turtle_.translation, width / 2};
    if (context_.skin == 0)
        context_.bodies.add_taper(start_from_turtle_, from.place, state_.control_width, width, read_colour(),
                                  span, sink(true));
    else if (from.place != to.place && std::max(from.radius, to.radius) > 0)
        extend_limb(from, to, read_colour(), span);
    for (const WidthSource source : {WidthSource::start, WidthSource::unit, WidthSource::sizes})
        note_radius(std::max(width, state_.control_width) / 2, source); // its two widths may have any
    start_cylinder();
}

TurtleState Turtle::state() const {
    TurtleState result = state_;
    const Mat3 turtle_from_start = glm::transpose(start_from_turtle_.linear);
    result.tropism = turtle_from_start * state_.tropism;
    result.vertical = turtle_from_start * state_.vertical;
    result.open_polygons = state_.open_polygons + static_cast<std::uint32_t>(polygons_.size());
    if (state_.in_cylinder)
        result.control_point = turtle_from_start * (state_.control_point - start_from_turtle_.translation);
    if (context_.two_headings) result.second = glm::quat_cast(turtle_from_start * second_);
    if (state_.frame)
        result.frame = std::make_shared<TurtleFrame>(seen_from(*state_.frame, start_from_turtle_, 1));
    if (scale_ == 1) return result;
    result = scaled(result, 1 / scale_);
    result.unit = state_.unit; // the step, too, is longer by the scale
    result.ruler = state_.ruler / scale_;
    if (context_.relative_width) result.width = state_.width;
    return result;
}

TurtlePart Turtle::finish() && {
    part_.start_from_exit = start_from_turtle_;
    part_.exit_scale = scale_;
    part_.mirrors = mirrored_;
    part_.exit = state_;
    if (writes_ & reads_second)
        part_.exit.second = glm::quat_cast(glm::transpose(start_from_turtle_.linear) * second_);
    part_.polygons = std::move(polygons_);
    if (context_.skin > 0) part_.limbs.push_back(std::move(limb_));
    part_.exit_way = way_;
    part_.error = {error_.turn, error_.shift, part_.error.farthest};
    part_.size_error.exit_shift = size_shift_;
    part_.sensitivity = {sensitivity_.turn, sensitivity_.shift, part_.sensitivity.farthest};
    part_.unit_sensitivity.exit_shift = unit_shift_;
    part_.exit_width_source = width_source_;
    part_.exit_width_error = width_error_;
    part_.writes = writes_;
    part_.cut = cut_depth_ > 0;
    part_.modules += modules_;
    part_.segments += segments_;
    part_.bodies += bodies_;
    return std::move(part_);
}

} // namespace graftal
